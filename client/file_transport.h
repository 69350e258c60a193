// PM files on this machine, whole or partial.
#pragma once

#include <optional>
#include <string>

#include "client/transport.h"
#include "core/files/read_file.h"

namespace pmesh {

class FileTransport : public Transport {
 public:
  FileTransport(std::string path, const TransportOptions& options);
  TransportStatus open() override;
  TransportStatus read(const ReadRequest& request, const ByteSink& sink) override;

 private:
  std::string path_;
  const CancelFlag* cancel_;
  std::optional<RandomAccessFile> file_;
};

}  // namespace pmesh
