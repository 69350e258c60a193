// A transport that goes over to another one for good when its wire is not to be had: WebSocket,
// which proxies and firewalls may refuse, and then plain HTTP to the same host.
#pragma once

#include <memory>

#include "client/transport.h"

namespace pmesh {

class FallbackTransport : public Transport {
 public:
  /// Both for the same file.
  FallbackTransport(std::unique_ptr<Transport> first, std::unique_ptr<Transport> second);

  /// Goes over when the first one fails because another wire is wanted, or twice in a row without a
  /// byte between. That failure, made retryable, says so; the next open() is the second one's.
  TransportStatus open() override;
  TransportStatus read(const ReadRequest& request, const ByteSink& sink) override;
  const RemoteFile& remote() const override { return current_->remote(); }

 private:
  TransportStatus judge(TransportStatus failed);

  std::unique_ptr<Transport> current_;
  std::unique_ptr<Transport> second_;  // null once it is the current one
  int failures_ = 0;                   // in a row, without a byte between
};

}  // namespace pmesh
