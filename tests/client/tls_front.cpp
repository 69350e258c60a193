#include "tests/client/tls_front.h"

#include <algorithm>
#include <cstdlib>

#include <openssl/bio.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>
#include <poll.h>

namespace pmesh::test {
namespace {

constexpr int kPatienceMilliseconds = 10'000;

template <class T>
using Owned = std::unique_ptr<T, void (*)(T*)>;

void require(bool condition) {
  if (!condition) std::abort();
}

// Valid from an hour ago for a day.
Owned<X509> self_signed(EVP_PKEY* key, const std::string& name) {
  Owned<X509> certificate(X509_new(), X509_free);
  X509* const x = certificate.get();
  X509_set_version(x, X509_VERSION_3);
  ASN1_INTEGER_set(X509_get_serialNumber(x), 1);
  X509_gmtime_adj(X509_getm_notBefore(x), -3600);
  X509_gmtime_adj(X509_getm_notAfter(x), 24 * 3600);
  X509_set_pubkey(x, key);
  X509_NAME* const subject = X509_get_subject_name(x);
  X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_ASC,
                             reinterpret_cast<const unsigned char*>("pmesh test"), -1, -1, 0);
  X509_set_issuer_name(x, subject);
  const bool is_address = name.find_first_not_of("0123456789.") == std::string::npos;
  const std::string alternative = (is_address ? "IP:" : "DNS:") + name;
  const Owned<X509_EXTENSION> extension(
      X509V3_EXT_conf_nid(nullptr, nullptr, NID_subject_alt_name, alternative.c_str()),
      X509_EXTENSION_free);
  require(X509_add_ext(x, extension.get(), -1) == 1 && X509_sign(x, key, EVP_sha256()) > 0);
  return certificate;
}

std::string to_pem(X509* certificate) {
  const Owned<BIO> memory(BIO_new(BIO_s_mem()), BIO_free_all);
  require(PEM_write_bio_X509(memory.get(), certificate) == 1);
  char* text = nullptr;
  const long size = BIO_get_mem_data(memory.get(), &text);
  return {text, static_cast<std::size_t>(size)};
}

// What has come inside, up to a block; nothing at the end.
Bytes read(SSL* tls) {
  Bytes bytes(64 * 1024);
  const int count = SSL_read(tls, bytes.data(), static_cast<int>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max(count, 0)));
  return bytes;
}

}  // namespace

TlsFront::TlsFront(std::uint16_t server_port, const std::string& name)
    : server_port_(server_port),
      context_(SSL_CTX_new(TLS_server_method()), SSL_CTX_free),
      server_([this](Peer& client) { serve(client); }) {
  const Owned<EVP_PKEY> key(EVP_EC_gen("P-256"), EVP_PKEY_free);
  const Owned<X509> certificate = self_signed(key.get(), name);
  certificate_ = to_pem(certificate.get());
  require(SSL_CTX_use_certificate(context_.get(), certificate.get()) == 1 &&
          SSL_CTX_use_PrivateKey(context_.get(), key.get()) == 1);
}

void TlsFront::serve(Peer& client) {
  const Owned<SSL> tls(SSL_new(context_.get()), SSL_free);
  SSL_set_fd(tls.get(), client.descriptor());
  if (SSL_accept(tls.get()) != 1) return;
  Peer server(connect_to(server_port_));
  pollfd ends[] = {{client.descriptor(), POLLIN, 0}, {server.descriptor(), POLLIN, 0}};
  while (SSL_pending(tls.get()) > 0 || ::poll(ends, 2, kPatienceMilliseconds) > 0) {
    if (SSL_pending(tls.get()) > 0 || ends[0].revents != 0) {
      const Bytes request = read(tls.get());
      if (request.empty() || !server.send(request)) return;
    }
    if (ends[1].revents != 0) {
      const Bytes answer = server.receive();
      if (answer.empty()) break;
      if (SSL_write(tls.get(), answer.data(), static_cast<int>(answer.size())) <= 0) return;
    }
  }
  SSL_shutdown(tls.get());
}

}  // namespace pmesh::test
