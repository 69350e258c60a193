// What a server says to a client in frames (docs/protocol.md, section 3), whatever carries them:
// one coroutine reads frames and acts on them, another sends answers and the data of the wants that
// stand, a frame of each stream in turn.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "protocol/messages.h"
#include "server/frames/frame_wire.h"
#include "server/net/deadline.h"
#include "server/net/signal.h"
#include "server/services.h"

namespace pmesh {

/// What a client has shown to be let in. A WebSocket's come with its HTTP request.
struct FrameCredentials {
  std::string authorization;  ///< As the HTTP field has it: "Bearer TOKEN".
  std::string id;             ///< The mesh that `query` is for.
  std::string query;          ///< Of a signed URL.
};

/// Threads: all on the wire's executor. The wire must outlive the conversation.
class FrameConversation {
 public:
  /// `policy` is the one that stands while the connection lasts; access is judged by the one that
  /// stands when a mesh is opened. `client` is for the log.
  FrameConversation(FrameWire& wire, Services& services, PolicyPtr policy, std::string client,
                    FrameCredentials credentials = {});

  ~FrameConversation();

  /// The whole conversation, and the connection's end. `owner` keeps this object: the reader may
  /// outlive a writer that fails.
  Awaitable<void> run(std::shared_ptr<void> owner);

  /// Lets the wants under way end, and then the conversation.
  void drain();

 private:
  /// A want under way: the bytes [next, level.end) are still to be sent.
  struct Transfer {
    std::uint64_t next = 0;
    Resolution level;
    bool paused = false;
  };
  struct Stream {
    MeshPtr mesh;
    std::optional<Transfer> transfer;

    bool is_sending() const { return transfer && !transfer->paused; }
  };
  using Streams = std::map<std::uint16_t, Stream>;

  Awaitable<void> read_frames();
  Awaitable<void> wait_for_room();
  void take_frame(const Frame& frame);
  void take_hello(const Frame& frame);
  void take_authorise(const Frame& frame);
  void take_open(const Frame& frame);
  bool may_open(const std::string& id, const std::string& query) const;
  void open_mesh(std::uint16_t stream, const Open& open);
  void take_want(const Frame& frame);
  void begin_transfer(std::uint16_t id, Stream& stream, const Want& want);
  void take_control(const Frame& frame);
  void end_transfer(std::uint16_t id, Stream& stream, std::string reason);

  Awaitable<bool> write_frames();
  Awaitable<bool> send_next_answer();
  Awaitable<bool> send_next_data(Streams::iterator stream);
  Streams::iterator next_sending();

  void be_patient();
  void on_idle();
  void enqueue(Bytes frame);
  void fail(std::uint16_t stream, FailureCode code, std::string text);
  void end_with(FailureCode code, std::string text);

  FrameWire& wire_;
  Services& services_;
  const PolicyPtr policy_;
  const std::string client_;
  FrameCredentials credentials_;
  std::optional<Hello> peer_;  // set once its hello has come
  Streams streams_;
  std::uint16_t last_sent_ = kConnectionStream;  // whose turn it was

  std::deque<Bytes> answers_;  // to be sent before any more data
  std::size_t answer_bytes_ = 0;
  Signal work_;  // the writer waits for answers, a transfer or the end
  Signal room_;  // the reader waits for answers to have been sent
  std::shared_ptr<Deadline> idle_;
  bool draining_ = false;
  bool ending_ = false;  // say what is queued, then close
  bool reading_ = true;  // the reader runs
  bool writing_ = true;  // the writer runs
};

}  // namespace pmesh
