// PM files over HTTP: from a pmesh server, which resolves wishes itself, and from any web server
// that gives out files, with ranges or without.
#pragma once

#include "client/http_client.h"
#include "client/mesh_url.h"
#include "client/transport.h"

namespace pmesh {

/// A mesh of a pmesh server: the id's JSON names the file by its hash; bytes are then asked by the
/// wish, or by a range once the end is known. To a wish that the server refuses it gives the first
/// 16 KiB, from which the client can tell why.
class HttpMeshTransport : public Transport {
 public:
  HttpMeshTransport(HttpMesh mesh, const TransportOptions& options);
  TransportStatus open() override;
  TransportStatus read(const ReadRequest& request, const ByteSink& sink) override;

 private:
  HttpMesh mesh_;
  HttpClient client_;
};

/// A file on any web server. The index is found by reading 16 KiB blind.
class HttpFileTransport : public Transport {
 public:
  HttpFileTransport(HttpFile file, const TransportOptions& options);
  /// Only drops an old connection: nothing is known before the first bytes.
  TransportStatus open() override;
  TransportStatus read(const ReadRequest& request, const ByteSink& sink) override;

 private:
  TransportStatus take_head(const HttpResponse& response);

  HttpFile file_;
  HttpClient client_;
};

}  // namespace pmesh
