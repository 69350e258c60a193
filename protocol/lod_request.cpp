#include "protocol/lod_request.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/base/parse_number.h"

namespace pmesh {
namespace {

Result<LodRequest> parse_count(WishKind kind, std::string_view key, std::string_view value) {
  const auto count = parse_whole<std::uint64_t>(value);
  if (!count) return usage_error("wish " + std::string(key) + ": expected a whole number");
  return LodRequest{.kind = kind, .count = *count};
}

Result<LodRequest> parse_ratio(std::string_view value) {
  const auto ratio = parse_whole<double>(value);
  if (!ratio || !(*ratio > 0 && *ratio <= 1)) {
    return usage_error("wish ratio: expected a number above 0 and at most 1");
  }
  return LodRequest{.kind = WishKind::ratio, .ratio = *ratio};
}

Result<LodRequest> parse_error(std::string_view value) {
  const bool is_percent = value.ends_with('%');
  if (is_percent) value.remove_suffix(1);
  const auto error = parse_whole<double>(value);
  if (!error || !std::isfinite(*error) || *error < 0) {
    return usage_error(
        "wish error: expected a finite number of at least 0, in the mesh's units or with % in "
        "percent of the bounding box's diagonal");
  }
  return LodRequest{.kind = WishKind::error, .error = *error, .error_is_percent = is_percent};
}

Result<LodRequest> parse_chunks(std::string_view value) {
  const std::size_t dash = value.find('-');
  if (dash == std::string_view::npos) return usage_error("wish chunks: expected first-last");
  const auto first = parse_whole<std::uint64_t>(value.substr(0, dash));
  const auto last = parse_whole<std::uint64_t>(value.substr(dash + 1));
  if (!first || !last) return usage_error("wish chunks: expected first-last");
  if (*first > *last) return usage_error("wish chunks: the first is after the last");
  return LodRequest{.kind = WishKind::chunks, .first_chunk = *first, .last_chunk = *last};
}

std::string shortest(double value) {
  char text[32];
  const auto [end, error] = std::to_chars(std::begin(text), std::end(text), value);
  return {text, end};
}

/// How many splits of a chunk add one face, being on a border; the others add two.
std::uint64_t border_splits(const FileIndex& index, std::size_t chunk) {
  const auto [splits, faces] = index.added_by_splits(chunk);
  return 2 * splits > faces ? std::min(2 * splits - faces, splits) : 0;
}

/// The LOD that ends with chunk `chunk_count` - 1.
Resolution prefix(const FileIndex& index, std::size_t chunk_count) {
  return {.end = index.prefix_bytes(chunk_count),
          .chunk_count = chunk_count,
          .faces = index.faces_after(chunk_count),
          .vertices = index.vertices_after(chunk_count)};
}

Resolution whole_file(const FileIndex& index) {
  Resolution everything = prefix(index, index.chunks.size());
  everything.end = index.header.file_bytes;
  return everything;
}

/// The LOD inside chunk `chunk` that its new components and `splits` splits make, of which
/// `faces` are all.
Resolution inside(const FileIndex& index, std::size_t chunk, std::uint64_t splits,
                  std::uint64_t faces) {
  Resolution lod = prefix(index, chunk + 1);
  const MeshCounts arrivals = index.chunks[chunk].arrivals;
  lod.vertices = index.vertices_after(chunk) + arrivals.vertices + splits;
  lod.faces = index.faces_after(chunk) + arrivals.faces + faces;
  return lod;
}

/// The base mesh, for a wish that wants less than it.
Resolution unreached(const FileIndex& index) {
  Resolution base = prefix(index, 0);
  base.reached = false;
  return base;
}

/// The most chunks c, 0 to all, for which `fits(c)` holds; it must hold for 0, and for every
/// fewer chunks than it holds for.
template <class Predicate>
std::size_t most_chunks(const FileIndex& index, Predicate fits) {
  std::size_t low = 0, high = index.chunks.size();
  while (low < high) {
    const std::size_t middle = low + (high - low + 1) / 2;
    if (fits(middle)) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return low;
}

Resolution resolve_faces(std::uint64_t count, const FileIndex& index) {
  if (count < index.header.base_faces) return unreached(index);
  const std::size_t whole =
      most_chunks(index, [&](std::size_t c) { return index.faces_after(c) <= count; });
  const Resolution lod = prefix(index, whole);
  if (whole == index.chunks.size()) return lod;

  const MeshCounts arrivals = index.chunks[whole].arrivals;
  if (count - lod.faces < arrivals.faces) return lod;
  const std::uint64_t spare = count - lod.faces - arrivals.faces;
  const std::uint64_t on_border = border_splits(index, whole);
  const std::uint64_t border = std::min(spare, on_border);
  const std::uint64_t splits = border + (spare - border) / 2;
  if (splits == 0 && arrivals.faces == 0) return lod;
  return inside(index, whole, splits, on_border == 0 ? 2 * splits : spare);
}

Resolution resolve_vertices(std::uint64_t count, const FileIndex& index) {
  if (count < index.header.base_vertices) return unreached(index);
  const std::size_t whole =
      most_chunks(index, [&](std::size_t c) { return index.vertices_after(c) <= count; });
  const Resolution lod = prefix(index, whole);
  if (whole == index.chunks.size() || lod.vertices == count) return lod;

  const MeshCounts arrivals = index.chunks[whole].arrivals;
  if (count - lod.vertices < arrivals.vertices) return lod;
  const std::uint64_t splits = count - lod.vertices - arrivals.vertices;
  const std::uint64_t all_splits = index.added_by_splits(whole).vertices;
  return inside(index, whole, splits,
                splits + std::min(splits, all_splits - border_splits(index, whole)));
}

Resolution resolve_bytes(std::uint64_t count, const FileIndex& index) {
  if (count < index.base_end()) return unreached(index);
  return prefix(index,
                most_chunks(index, [&](std::size_t c) { return index.prefix_bytes(c) <= count; }));
}

/// Errors need not fall from row to row, so this is no binary search.
Result<Resolution> resolve_error(const LodRequest& wish, const FileIndex& index) {
  if (!index.header.errors_measured) {
    return usage_error("wish error: this file was precomputed without measured errors");
  }
  const double bound =
      wish.error_is_percent ? wish.error / 100 * index.header.box_diagonal() : wish.error;
  for (std::size_t c = 0; c < index.chunks.size(); ++c) {
    if (index.chunks[c].max_error <= bound) return prefix(index, c + 1);
  }
  Resolution finest = whole_file(index);
  finest.reached = false;
  return finest;
}

Result<Resolution> resolve_chunks(const LodRequest& wish, const FileIndex& index) {
  if (wish.last_chunk >= index.chunks.size()) {
    return usage_error("wish chunks: the file has " + std::to_string(index.chunks.size()) +
                       " chunks");
  }
  Resolution pieces = prefix(index, static_cast<std::size_t>(wish.last_chunk) + 1);
  const auto first = static_cast<std::size_t>(wish.first_chunk);
  pieces.begin = first == 0 ? 0 : index.chunks[first].offset;
  return pieces;
}

}  // namespace

Result<LodRequest> parse_wish(std::string_view query) {
  if (query.empty()) return LodRequest{};
  if (query.find('&') != std::string_view::npos)
    return usage_error("expected one wish, found several");
  const std::size_t equals = query.find('=');
  if (equals == std::string_view::npos) return usage_error("expected a wish as key=value");
  const std::string_view key = query.substr(0, equals);
  const std::string_view value = query.substr(equals + 1);
  if (key == "faces") return parse_count(WishKind::faces, key, value);
  if (key == "vertices") return parse_count(WishKind::vertices, key, value);
  if (key == "ratio") return parse_ratio(value);
  if (key == "error") return parse_error(value);
  if (key == "bytes") return parse_count(WishKind::bytes, key, value);
  if (key == "chunks") return parse_chunks(value);
  return usage_error("unknown wish; expected faces, vertices, ratio, error, bytes or chunks");
}

std::string to_query(const LodRequest& wish) {
  switch (wish.kind) {
    case WishKind::everything:
      return "";
    case WishKind::faces:
      return "faces=" + std::to_string(wish.count);
    case WishKind::vertices:
      return "vertices=" + std::to_string(wish.count);
    case WishKind::ratio:
      return "ratio=" + shortest(wish.ratio);
    case WishKind::error:
      return "error=" + shortest(wish.error) + (wish.error_is_percent ? "%" : "");
    case WishKind::bytes:
      return "bytes=" + std::to_string(wish.count);
    case WishKind::chunks:
      return "chunks=" + std::to_string(wish.first_chunk) + "-" + std::to_string(wish.last_chunk);
  }
  return "";
}

std::uint64_t faces_of_ratio(double ratio, const FileIndex& index) {
  return static_cast<std::uint64_t>(std::floor(ratio * static_cast<double>(index.header.faces)));
}

Result<Resolution> resolve(const LodRequest& wish, const FileIndex& index) {
  switch (wish.kind) {
    case WishKind::everything:
      break;
    case WishKind::faces:
      return resolve_faces(wish.count, index);
    case WishKind::vertices:
      return resolve_vertices(wish.count, index);
    case WishKind::ratio:
      return resolve_faces(faces_of_ratio(wish.ratio, index), index);
    case WishKind::error:
      return resolve_error(wish, index);
    case WishKind::bytes:
      return resolve_bytes(wish.count, index);
    case WishKind::chunks:
      return resolve_chunks(wish, index);
  }
  return whole_file(index);
}

}  // namespace pmesh
