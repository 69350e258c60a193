#include "client/mesh_url.h"

#include <gtest/gtest.h>

namespace pmesh {
namespace {

template <class Kind>
Kind parsed(const char* text) {
  return std::get<Kind>(*parse_mesh_url(text));
}

TEST(MeshUrl, NamesAMeshOfAPmeshServer) {
  const auto mesh = parsed<HttpMesh>("http://localhost:8080/bunny");
  EXPECT_EQ(mesh.endpoint.text(), "localhost:8080");
  EXPECT_EQ(mesh.prefix, "");
  EXPECT_EQ(mesh.id, "bunny");
}

TEST(MeshUrl, KeepsAProxysPathBeforeTheId) {
  const auto mesh = parsed<HttpMesh>("http://example.org/scans/v1/bunny");
  EXPECT_EQ(mesh.endpoint.text(), "example.org:80");
  EXPECT_EQ(mesh.prefix, "/scans/v1");
  EXPECT_EQ(mesh.id, "bunny");
}

TEST(MeshUrl, NamesAFileOfAnyWebServerWithItsQuery) {
  const auto file = parsed<HttpFile>("http://example.org/a/b.pmesh?token=x%20y");
  EXPECT_EQ(file.endpoint.text(), "example.org:80");
  EXPECT_EQ(file.target, "/a/b.pmesh?token=x%20y");
}

TEST(MeshUrl, DropsAFragment) {
  EXPECT_EQ(parsed<HttpFile>("http://example.org/b.pmesh#top").target, "/b.pmesh");
}

TEST(MeshUrl, NamesAMeshOfTheFrameProtocol) {
  const auto mesh = parsed<TcpMesh>("tcp://10.0.0.1:9000/scans~bunny");
  EXPECT_EQ(mesh.endpoint.text(), "10.0.0.1:9000");
  EXPECT_EQ(mesh.id, "scans~bunny");
}

TEST(MeshUrl, NamesAMeshByWebSocketAsByHttp) {
  const auto mesh = parsed<WebSocketMesh>("ws://example.org/scans/bunny").mesh;
  EXPECT_EQ(mesh.endpoint.text(), "example.org:80");
  EXPECT_EQ(mesh.prefix, "/scans");
  EXPECT_EQ(mesh.id, "bunny");
  EXPECT_FALSE(mesh.endpoint.is_secure);
}

TEST(MeshUrl, KnowsItsSchemesWithTls) {
  const auto https = parsed<HttpMesh>("https://h/bunny").endpoint;
  EXPECT_EQ(https.text(), "h:443");
  EXPECT_TRUE(https.is_secure);
  EXPECT_TRUE(parsed<HttpFile>("https://h/b.pmesh").endpoint.is_secure);
  EXPECT_EQ(parsed<WebSocketMesh>("wss://h/bunny").mesh.endpoint.text(), "h:443");
  EXPECT_TRUE(parsed<WebSocketMesh>("wss://h:9/bunny").mesh.endpoint.is_secure);
  EXPECT_TRUE(parsed<TcpMesh>("tcps://h:9/bunny").endpoint.is_secure);
}

TEST(MeshUrl, KeepsTheQueryOfASignedUrl) {
  const auto mesh = parsed<HttpMesh>("http://h/bunny?expires=9&signature=ab-_");
  EXPECT_EQ(mesh.id, "bunny");
  EXPECT_EQ(mesh.query, "expires=9&signature=ab-_");
  EXPECT_EQ(parsed<WebSocketMesh>("ws://h/bunny?a=b").mesh.query, "a=b");
  EXPECT_EQ(parsed<TcpMesh>("tcp://h:1/bunny?a=b").query, "a=b");
  EXPECT_EQ(parsed<HttpMesh>("http://h/bunny?").query, "");
}

TEST(MeshUrl, TakesASchemeInAnyCase) {
  EXPECT_EQ(parsed<HttpMesh>("HTTP://h/bunny").id, "bunny");
  EXPECT_EQ(parsed<TcpMesh>("Tcp://h:1/bunny").id, "bunny");
}

TEST(MeshUrl, UnderstandsIpv6Addresses) {
  const auto mesh = parsed<TcpMesh>("tcp://[::1]:9000/bunny");
  EXPECT_EQ(mesh.endpoint.host, "::1");
  EXPECT_EQ(mesh.endpoint.text(), "[::1]:9000");
}

TEST(MeshUrl, TakesAnythingWithoutASchemeAsAPath) {
  EXPECT_EQ(parsed<LocalFile>("../some dir/x.pmesh").path, "../some dir/x.pmesh");
}

TEST(MeshUrl, RefusesWhatItCannotMean) {
  for (const char* text : {"",
                           "ftp://h/b.pmesh",
                           "httpss://h/b",
                           "ws://h/b.pmesh/",
                           "ws://h/?b",
                           "ws://h/b?ratio=1",
                           "wss://h/b?a=1&bytes=2",
                           "tcps://h/bunny",
                           "http://",
                           "http:///b",
                           "http://h",
                           "http://h/",
                           "http://h:/b",
                           "http://h:0/b",
                           "http://h:65536/b",
                           "http://h:80x/b",
                           "http://h:80:80/b",
                           "http://u@h/b",
                           "http://[::1/b",
                           "http://[x]/b",
                           "http://h/a b.pmesh",
                           "http://h/b\n",
                           "http://h/bunny?faces=100",
                           "http://h/..",
                           "http://h/a%2fb",
                           "http://h/catalog",
                           "tcp://h/bunny",
                           "tcp://h:1/",
                           "tcp://h:1",
                           "tcp://h:1?bunny",
                           "tcp://h:1/?bunny",
                           "tcp://h:1/a/b"}) {
    const Result<MeshUrl> url = parse_mesh_url(text);
    ASSERT_FALSE(url.ok()) << text;
    EXPECT_EQ(url.error().code, ErrorCode::usage) << text;
  }
}

TEST(MeshUrl, SaysWhatIsWrong) {
  EXPECT_NE(parse_mesh_url("tcp://h/bunny").error().message.find("port"), std::string::npos);
  EXPECT_NE(parse_mesh_url("http://h/b?faces=1").error().message.find("option"), std::string::npos);
}

}  // namespace
}  // namespace pmesh
