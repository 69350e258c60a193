#include "protocol/messages.h"

#include <algorithm>
#include <cassert>

namespace pmesh {
namespace {

constexpr std::string_view kHelloMagic = "PMTP";
constexpr std::size_t kMaxFailureText = 512;

std::string_view as_text(ByteView bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void put_hash(ByteWriter& writer, const ContentHash& hash) { writer.put(ByteView(hash)); }

ContentHash get_hash(ByteReader& reader) {
  ContentHash hash{};
  const ByteView bytes = reader.take(hash.size());
  std::copy(bytes.begin(), bytes.end(), hash.begin());
  return hash;
}

Error wrong_size(const std::string& message) {
  return bad_input(message + ": the payload has the wrong size");
}

/// Success if all of the payload was read and nothing was missing.
Status check_end(const ByteReader& reader, const std::string& message) {
  if (reader.failed() || reader.remaining() > 0) return wrong_size(message);
  return {};
}

}  // namespace

Bytes encode_hello(const Hello& hello) {
  Bytes payload;
  ByteWriter writer(payload);
  writer.put(as_bytes(kHelloMagic));
  writer.put(hello.version);
  writer.put(hello.max_frame);
  return encode_frame(FrameType::hello, kConnectionStream, payload);
}

Result<Hello> parse_hello(ByteView payload) {
  ByteReader reader(payload);
  if (as_text(reader.take(kHelloMagic.size())) != kHelloMagic) {
    return bad_input("hello: the magic is not \"PMTP\"");
  }
  Hello hello;
  hello.version = reader.get<std::uint16_t>();
  if (reader.failed()) return wrong_size("hello");
  if (hello.version != kProtocolVersion) return hello;
  hello.max_frame = reader.get<std::uint32_t>();
  if (Status end = check_end(reader, "hello"); !end) return end.error();
  if (hello.max_frame < kMinFrameLimit) {
    return bad_input("hello: max_frame is below " + std::to_string(kMinFrameLimit));
  }
  return hello;
}

Bytes encode_open(std::uint16_t stream, const Open& open) {
  assert(open.id.size() <= 0xFFFF);
  Bytes payload;
  ByteWriter writer(payload);
  writer.put(static_cast<std::uint16_t>(open.id.size()));
  writer.put(as_bytes(open.id));
  if (open.hash) put_hash(writer, *open.hash);
  return encode_frame(FrameType::open, stream, payload);
}

Result<Open> parse_open(ByteView payload) {
  ByteReader reader(payload);
  Open open;
  open.id = as_text(reader.take(reader.get<std::uint16_t>()));
  if (reader.remaining() > 0) open.hash = get_hash(reader);
  if (Status end = check_end(reader, "open"); !end) return end.error();
  return open;
}

Bytes encode_opened(std::uint16_t stream, const Opened& opened) {
  Bytes payload;
  ByteWriter writer(payload);
  put_hash(writer, opened.hash);
  writer.put(opened.file_bytes);
  writer.put(opened.vertices);
  writer.put(opened.faces);
  writer.put(opened.base_vertices);
  writer.put(opened.base_faces);
  writer.put(opened.chunks);
  return encode_frame(FrameType::opened, stream, payload);
}

Result<Opened> parse_opened(ByteView payload) {
  ByteReader reader(payload);
  Opened opened;
  opened.hash = get_hash(reader);
  opened.file_bytes = reader.get<std::uint64_t>();
  opened.vertices = reader.get<std::uint64_t>();
  opened.faces = reader.get<std::uint64_t>();
  opened.base_vertices = reader.get<std::uint64_t>();
  opened.base_faces = reader.get<std::uint64_t>();
  opened.chunks = reader.get<std::uint32_t>();
  if (Status end = check_end(reader, "opened"); !end) return end.error();
  return opened;
}

Bytes encode_want(std::uint16_t stream, const Want& want) {
  Bytes payload;
  ByteWriter writer(payload);
  writer.put(want.from_offset);
  writer.put(as_bytes(to_query(want.wish)));
  return encode_frame(FrameType::want, stream, payload);
}

Result<Want> parse_want(ByteView payload) {
  ByteReader reader(payload);
  Want want;
  want.from_offset = reader.get<std::uint64_t>();
  if (reader.failed()) return wrong_size("want");
  auto wish = parse_wish(as_text(reader.take(reader.remaining())));
  if (!wish) return prefixed("want", wish.error());
  want.wish = *wish;
  return want;
}

Bytes encode_data(std::uint16_t stream, const Data& data) {
  Bytes frame = encode_data_header(stream, data.offset, data.bytes.size());
  frame.insert(frame.end(), data.bytes.begin(), data.bytes.end());
  return frame;
}

Bytes encode_data_header(std::uint16_t stream, std::uint64_t offset, std::size_t byte_count) {
  const auto header = frame_header(FrameType::data, stream, kDataHeaderBytes + byte_count);
  Bytes bytes(header.begin(), header.end());
  ByteWriter(bytes).put(offset);
  return bytes;
}

Result<Data> parse_data(ByteView payload) {
  ByteReader reader(payload);
  Data data;
  data.offset = reader.get<std::uint64_t>();
  if (reader.failed()) return wrong_size("data");
  data.bytes = reader.take(reader.remaining());
  return data;
}

Bytes encode_done(std::uint16_t stream, const Done& done) {
  Bytes payload;
  ByteWriter writer(payload);
  writer.put(done.end);
  writer.put(done.faces);
  writer.put(done.vertices);
  writer.put(static_cast<std::uint8_t>(done.reached));
  return encode_frame(FrameType::done, stream, payload);
}

Result<Done> parse_done(ByteView payload) {
  ByteReader reader(payload);
  Done done;
  done.end = reader.get<std::uint64_t>();
  done.faces = reader.get<std::uint64_t>();
  done.vertices = reader.get<std::uint64_t>();
  const auto reached = reader.get<std::uint8_t>();
  if (Status end = check_end(reader, "done"); !end) return end.error();
  if (reached > 1) return bad_input("done: reached is neither 0 nor 1");
  done.reached = reached == 1;
  return done;
}

Bytes encode_failure(std::uint16_t stream, const Failure& failure) {
  Bytes payload;
  ByteWriter writer(payload);
  writer.put(static_cast<std::uint16_t>(failure.code));
  writer.put(as_bytes(std::string_view(failure.text).substr(0, kMaxFailureText)));
  return encode_frame(FrameType::failure, stream, payload);
}

Result<Failure> parse_failure(ByteView payload) {
  ByteReader reader(payload);
  Failure failure;
  failure.code = static_cast<FailureCode>(reader.get<std::uint16_t>());
  if (reader.failed()) return wrong_size("failure");
  if (reader.remaining() > kMaxFailureText) return wrong_size("failure");
  failure.text = as_text(reader.take(reader.remaining()));
  return failure;
}

Bytes encode_authorise(std::string_view token) {
  return encode_frame(FrameType::authorise, kConnectionStream, as_bytes(token));
}

Bytes encode_empty(FrameType type, std::uint16_t stream) { return encode_frame(type, stream, {}); }

}  // namespace pmesh
