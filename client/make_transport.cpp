#include "client/fallback_transport.h"
#include "client/file_transport.h"
#include "client/frame_transport.h"
#include "client/http_transport.h"
#include "client/tcp_wire.h"
#include "client/transport.h"
#include "client/websocket_wire.h"

namespace pmesh {
namespace {

struct Maker {
  const TransportOptions& options;

  std::unique_ptr<Transport> operator()(const HttpMesh& mesh) const {
    return std::make_unique<HttpMeshTransport>(mesh, options);
  }
  std::unique_ptr<Transport> operator()(const WebSocketMesh& socket) const {
    auto wire = std::make_unique<WebSocketWire>(socket.mesh, options);
    return std::make_unique<FallbackTransport>(
        std::make_unique<FrameTransport>(std::move(wire), socket.mesh.id), (*this)(socket.mesh));
  }
  std::unique_ptr<Transport> operator()(const HttpFile& file) const {
    return std::make_unique<HttpFileTransport>(file, options);
  }
  std::unique_ptr<Transport> operator()(const TcpMesh& mesh) const {
    const std::string id = mesh.query.empty() ? mesh.id : mesh.id + "?" + mesh.query;
    return std::make_unique<FrameTransport>(std::make_unique<TcpWire>(mesh.endpoint, options), id,
                                            options.token);
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
