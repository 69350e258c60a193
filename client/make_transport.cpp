#include "client/file_transport.h"
#include "client/http_transport.h"
#include "client/tcp_transport.h"
#include "client/transport.h"

namespace pmesh {
namespace {

struct Maker {
  const TransportOptions& options;

  std::unique_ptr<Transport> operator()(const HttpMesh& mesh) const {
    return std::make_unique<HttpMeshTransport>(mesh, options);
  }
  std::unique_ptr<Transport> operator()(const HttpFile& file) const {
    return std::make_unique<HttpFileTransport>(file, options);
  }
  std::unique_ptr<Transport> operator()(const TcpMesh& mesh) const {
    return std::make_unique<TcpTransport>(mesh, options);
  }
  std::unique_ptr<Transport> operator()(const LocalFile& file) const {
    return std::make_unique<FileTransport>(file.path, options);
  }
};

}  // namespace

std::unique_ptr<Transport> make_transport(const MeshUrl& url, const TransportOptions& options) {
  return std::visit(Maker{options}, url);
}

}  // namespace pmesh
