// PM files over HTTP: from a pmesh server, which resolves wishes itself, and from any web server
// that gives out files, with ranges or without.
//
// A host, or a cache before it, may answer a range with the whole file. If much of that is held
// already, the range is asked for once more, of whoever answers then; after a second such answer a
// pmesh server is asked for whole chunks, and of any other host the file is taken from its start.
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
  /// Asks for the JSON unless it has been asked for and its hash was still found by the last read.
  TransportStatus open() override;
  TransportStatus read(const ReadRequest& request, const ByteSink& sink) override;

 private:
  TransportStatus look_up();
  TransportStatus read_file(const ReadRequest& request, const ByteSink& sink, bool& is_declined);
  TransportStatus read_chunk(const ReadRequest& request, const ByteSink& sink);
  TransportStatus check(const HttpResponse& response, const std::string& target);
  std::string target_of(const std::string& route) const;

  HttpMesh mesh_;
  HttpClient client_;
  int whole_answers_ = 0;  // in a row, where a range was asked
  bool has_chunk_routes_ = true;
};

/// A file on any web server. The index is found by reading 16 KiB blind.
class HttpFileTransport : public Transport {
 public:
  HttpFileTransport(HttpFile file, const TransportOptions& options);
  /// Only drops an old connection: nothing is known before the first bytes.
  TransportStatus open() override;
  TransportStatus read(const ReadRequest& request, const ByteSink& sink) override;

 private:
  TransportStatus read_range(const ReadRequest& request, const ByteSink& sink, bool& is_declined);
  TransportStatus take_head(const HttpResponse& response);

  HttpFile file_;
  HttpClient client_;
  int whole_answers_ = 0;  // in a row, where a range was asked
};

}  // namespace pmesh
