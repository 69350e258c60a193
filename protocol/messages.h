// The messages of the TCP protocol: what the payloads of frames hold (docs/protocol.md, section
// 4). Numbers are little-endian, fields stand in the order given here without gaps, and a payload
// has exactly the size its fields need.
//
//   hello    "PMTP", u16 version, u32 max_frame
//   open     u16 id length, id [, 16 bytes hash]
//   opened   16 bytes hash, u64 file_bytes, u64 vertices, u64 faces, u64 base_vertices,
//            u64 base_faces, u32 chunks
//   want     u64 from_offset, the wish's text (up to the payload's end)
//   data     u64 offset, bytes (up to the payload's end)
//   done     u64 end, u64 faces, u64 vertices, u8 reached (0 or 1)
//   failure  u16 code, text (up to the payload's end)
//   authorise  a bearer token (up to the payload's end)
//   pause, resume, cancel, ping, pong: an empty payload
//
// Every encode_X gives a whole frame; every parse_X reads a frame's payload and fails (bad_input)
// with "X: what is wrong". Threads: pure functions.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/pm/format.h"
#include "protocol/frames.h"
#include "protocol/lod_request.h"

namespace pmesh {

inline constexpr std::uint16_t kProtocolVersion = 0;
/// The least max_frame a peer may announce; enough for every message but data.
inline constexpr std::uint32_t kMinFrameLimit = 1024;
inline constexpr std::size_t kDataHeaderBytes = 8;

/// The first message of either side.
struct Hello {
  std::uint16_t version = kProtocolVersion;
  std::uint32_t max_frame = kMaxFramePayload;  ///< The largest payload the sender takes.
  friend bool operator==(const Hello&, const Hello&) = default;
};

/// Client: opens a mesh on a stream, of any hash or of the given one only.
struct Open {
  std::string id;  ///< Perhaps with "?" and the query of a signed URL behind it.
  std::optional<ContentHash> hash;
  friend bool operator==(const Open&, const Open&) = default;
};

/// Server: the answer to Open.
struct Opened {
  ContentHash hash{};
  std::uint64_t file_bytes = 0;
  std::uint64_t vertices = 0;
  std::uint64_t faces = 0;
  std::uint64_t base_vertices = 0;
  std::uint64_t base_faces = 0;
  std::uint32_t chunks = 0;
  friend bool operator==(const Opened&, const Opened&) = default;
};

/// Client: asks for the wish's bytes from `from_offset` on. Replaces an earlier want.
struct Want {
  std::uint64_t from_offset = 0;
  LodRequest wish;
  friend bool operator==(const Want&, const Want&) = default;
};

/// Server: bytes of the file. The view points into the payload that was parsed.
struct Data {
  std::uint64_t offset = 0;
  ByteView bytes;
};

/// Server: the want is fulfilled.
struct Done {
  std::uint64_t end = 0;    ///< One past the last byte that the want came to.
  std::uint64_t faces = 0;  ///< As Resolution has them.
  std::uint64_t vertices = 0;
  bool reached = true;
  friend bool operator==(const Done&, const Done&) = default;
};

/// On stream 0 the sender closes the connection after it; on another stream it is the answer to
/// one open or want.
enum class FailureCode : std::uint16_t {
  protocol_error = 1,       ///< Stream 0: a frame or message breaks the rules.
  unsupported_version = 2,  ///< Stream 0: no common version.
  idle_timeout = 3,         ///< Stream 0: nothing was asked for too long.
  shutting_down = 4,        ///< Stream 0: the server goes down.
  busy = 5,                 ///< Stream 0: too many connections. Open: the mesh cannot be read now.
  not_found = 6,            ///< Open: no such mesh.
  hash_changed = 7,         ///< Open: the mesh no longer has that hash.
  too_many_streams = 8,     ///< Open: this server opens fewer streams on one connection.
  not_open = 9,             ///< Want: no mesh is open on the stream.
  bad_wish = 10,            ///< Want: the wish or the offset makes no sense for this mesh.
  cancelled = 11,           ///< Want: it was cancelled or replaced.
  not_allowed = 12,         ///< Open: no token or signature allows the mesh.
};

struct Failure {
  FailureCode code = FailureCode::protocol_error;
  std::string text;  ///< For people; at most 512 bytes of UTF-8.
  friend bool operator==(const Failure&, const Failure&) = default;
};

Bytes encode_hello(const Hello& hello);
/// Precondition: an id of at most 65535 bytes.
Bytes encode_open(std::uint16_t stream, const Open& open);
Bytes encode_opened(std::uint16_t stream, const Opened& opened);
Bytes encode_want(std::uint16_t stream, const Want& want);
Bytes encode_data(std::uint16_t stream, const Data& data);
Bytes encode_done(std::uint16_t stream, const Done& done);
Bytes encode_failure(std::uint16_t stream, const Failure& failure);
/// Precondition: at most kMinFrameLimit bytes.
Bytes encode_authorise(std::string_view token);
/// Pause, resume, cancel, ping and pong.
Bytes encode_empty(FrameType type, std::uint16_t stream);

/// What stands before the file's bytes in a data frame of `byte_count` of them, for a sender that
/// hands those to the socket itself. Precondition: kDataHeaderBytes + byte_count fit a frame.
Bytes encode_data_header(std::uint16_t stream, std::uint64_t offset, std::size_t byte_count);

/// Of a version other than kProtocolVersion only the version is read: what follows is not known.
Result<Hello> parse_hello(ByteView payload);
/// Does not check the id: one that cannot be any mesh's is answered like one that is no mesh's.
Result<Open> parse_open(ByteView payload);
Result<Opened> parse_opened(ByteView payload);
/// Fails with code usage if only the wish's text is wrong: that is answered, not punished.
Result<Want> parse_want(ByteView payload);
Result<Data> parse_data(ByteView payload);
Result<Done> parse_done(ByteView payload);
Result<Failure> parse_failure(ByteView payload);

}  // namespace pmesh
