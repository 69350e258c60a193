#include "server/net/tls.h"

#include <new>

#include <openssl/err.h>

namespace pmesh {
namespace {

/// The first error in OpenSSL's queue, which is empty afterwards.
std::string tls_error() {
  char text[256];
  ERR_error_string_n(ERR_get_error(), text, sizeof text);
  ERR_clear_error();
  return text;
}

Error tls_failure(const std::string& path, const char* what) {
  return {ErrorCode::usage, path + ": " + what + ": " + tls_error()};
}

}  // namespace

Result<std::shared_ptr<const TlsContext>> TlsContext::load(const TlsOptions& options) {
  ERR_clear_error();
  std::shared_ptr<TlsContext> made(new TlsContext);
  made->context_.reset(SSL_CTX_new(TLS_server_method()));
  SSL_CTX* context = made->context_.get();
  if (context == nullptr) return Error{ErrorCode::out_of_resources, "TLS: " + tls_error()};
  SSL_CTX_set_min_proto_version(context, TLS1_2_VERSION);
  SSL_CTX_set_options(context, SSL_OP_NO_RENEGOTIATION | SSL_OP_CIPHER_SERVER_PREFERENCE |
                                   SSL_OP_IGNORE_UNEXPECTED_EOF);
  SSL_CTX_set_mode(context, SSL_MODE_ENABLE_PARTIAL_WRITE | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER |
                                SSL_MODE_RELEASE_BUFFERS);
  SSL_CTX_set_session_cache_mode(context, SSL_SESS_CACHE_OFF);  // tickets need no memory of ours
  if (SSL_CTX_use_certificate_chain_file(context, options.certificate.c_str()) != 1) {
    return tls_failure(options.certificate, "no certificate in PEM that can be used");
  }
  if (SSL_CTX_use_PrivateKey_file(context, options.key.c_str(), SSL_FILETYPE_PEM) != 1) {
    return tls_failure(options.key, "no private key in PEM that can be used");
  }
  if (SSL_CTX_check_private_key(context) != 1) {
    return tls_failure(options.key, "not the key of the certificate");
  }
  return std::shared_ptr<const TlsContext>(std::move(made));
}

TlsStream::TlsStream(const TlsContext& context, int socket) : ssl_(SSL_new(context.get())) {
  if (!ssl_ || SSL_set_fd(ssl_.get(), socket) != 1) throw std::bad_alloc();
  SSL_set_accept_state(ssl_.get());
}

WireStep TlsStream::handshake() {
  if (is_broken_) return {};
  ERR_clear_error();
  return step(SSL_do_handshake(ssl_.get()), 0);
}

WireStep TlsStream::read(std::span<char> into) {
  if (is_broken_) return {};
  std::size_t count = 0;
  ERR_clear_error();
  const int result = SSL_read_ex(ssl_.get(), into.data(), into.size(), &count);
  return step(result, count);
}

WireStep TlsStream::write(ByteView bytes) {
  if (is_broken_) return {};
  std::size_t count = 0;
  ERR_clear_error();
  const int result = SSL_write_ex(ssl_.get(), bytes.data(), bytes.size(), &count);
  return step(result, count);
}

void TlsStream::say_goodbye() {
  if (is_broken_ || SSL_is_init_finished(ssl_.get()) == 0) return;
  ERR_clear_error();
  SSL_shutdown(ssl_.get());
}

WireStep TlsStream::step(int result, std::size_t count) {
  if (result == 1) return {WireStep::moved, count};
  switch (SSL_get_error(ssl_.get(), result)) {
    case SSL_ERROR_WANT_READ:
      return {WireStep::must_read, 0};
    case SSL_ERROR_WANT_WRITE:
      return {WireStep::must_write, 0};
    case SSL_ERROR_ZERO_RETURN:
      return {};
    default:
      is_broken_ = true;  // OpenSSL must not be asked again, not even to say goodbye
      return {};
  }
}

}  // namespace pmesh
