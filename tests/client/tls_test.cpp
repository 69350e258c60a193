// The client and TLS: https, wss and tcps, and whom it trusts.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/client/fetched.h"
#include "tests/client/frame_host.h"
#include "tests/client/loopback.h"
#include "tests/client/sample.h"
#include "tests/client/tls_front.h"

namespace pmesh {
namespace {

using test::Fetched;
using test::FrameServer;
using test::HttpHost;
using test::LoopbackServer;
using test::Peer;
using test::sample_file;
using test::TlsFront;
using test::WebSocketServer;

class Tls : public testing::Test {
 protected:
  Tls() : ca_(testing::TempDir() + "pmesh_ca_" + std::to_string(::getpid()) + ".pem") {}
  ~Tls() override { std::filesystem::remove(ca_); }

  TransportOptions trusting(const TlsFront& front) const {
    std::ofstream(ca_) << front.certificate();
    return {.ca_file = ca_};
  }
  static std::string url(const std::string& scheme, const TlsFront& front, const std::string& path,
                         const std::string& host = "127.0.0.1") {
    return scheme + "://" + host + ":" + std::to_string(front.port()) + path;
  }

  std::string ca_;
};

TEST_F(Tls, CarriesEveryProtocol) {
  HttpHost host(sample_file(), {});
  FrameServer frames({});
  WebSocketServer web_socket({});
  const TlsFront https(host.port(), "127.0.0.1"), tcps(frames.port(), "127.0.0.1"),
      wss(web_socket.port(), "127.0.0.1");
  for (const auto& [scheme, front, path] :
       {std::tuple("https", &https, "/mesh"), std::tuple("https", &https, "/mesh.pmesh"),
        std::tuple("tcps", &tcps, "/mesh"), std::tuple("wss", &wss, "/mesh")}) {
    const Fetched fetched(url(scheme, *front, path), "", trusting(*front));
    EXPECT_EQ(fetched.error(), "") << scheme << path;
    EXPECT_TRUE(fetched.is_sample()) << scheme << path;
    EXPECT_TRUE(fetched.retries.empty()) << scheme << path;
  }
}

TEST_F(Tls, TrustsACertificateForTheHostsName) {
  HttpHost host(sample_file(), {});
  const TlsFront front(host.port(), "localhost");
  const Fetched fetched(url("https", front, "/mesh", "localhost"), "", trusting(front));
  EXPECT_EQ(fetched.error(), "");
}

TEST_F(Tls, DoesNotTrustACertificateForAnotherHost) {
  HttpHost host(sample_file(), {});
  const TlsFront front(host.port(), "localhost");
  const Fetched fetched(url("https", front, "/mesh"), "", trusting(front));
  EXPECT_NE(fetched.error().find("certificate"), std::string::npos) << fetched.error();
  EXPECT_TRUE(fetched.retries.empty());
  EXPECT_TRUE(host.targets().empty());
}

TEST_F(Tls, DoesNotTrustAnAuthorityThatTheSystemDoesNotKnow) {
  HttpHost host(sample_file(), {});
  const TlsFront front(host.port(), "127.0.0.1");
  for (const char* scheme : {"https", "wss", "tcps"}) {
    const Fetched fetched(url(scheme, front, "/mesh"));
    EXPECT_NE(fetched.error().find("certificate"), std::string::npos) << fetched.error();
    EXPECT_TRUE(fetched.retries.empty()) << scheme;
  }
  EXPECT_TRUE(host.targets().empty());
}

TEST_F(Tls, RefusesAFileOfAuthoritiesThatIsNone) {
  const Fetched fetched("https://127.0.0.1:9/mesh", "", {.ca_file = "no/such/file.pem"});
  ASSERT_FALSE(fetched.status.ok());
}

TEST_F(Tls, SaysThatAPlainServerSpeaksNoTls) {
  LoopbackServer host([](Peer& client) {
    client.receive();
    client.send(as_bytes("HTTP/1.1 400 Bad Request\r\n\r\n"));
  });
  const Fetched fetched("https://127.0.0.1:" + std::to_string(host.port()) + "/mesh");
  EXPECT_NE(fetched.error().find("TLS"), std::string::npos) << fetched.error();
}

}  // namespace
}  // namespace pmesh
