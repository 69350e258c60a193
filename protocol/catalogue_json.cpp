#include "protocol/catalogue_json.h"

#include <nlohmann/json.hpp>

#include "protocol/mesh_id.h"
#include "protocol/routes.h"

namespace pmesh {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(Vec3d point) { return Json::array({point.x, point.y, point.z}); }

Json error_json(const FileHeader& header, double distance) {
  return header.errors_measured ? Json(distance) : Json(nullptr);
}

/// The members that the catalogue and the mesh's own answer share.
Json summary_json(const CatalogueEntry& entry) {
  const FileHeader& header = entry.index->header;
  return {{"id", entry.id},
          {"hash", to_hex(header.content_hash)},
          {"file_bytes", header.file_bytes},
          {"vertices", header.vertices},
          {"faces", header.faces}};
}

Json chunk_json(const FileHeader& header, const ChunkRow& row) {
  return {{"offset", row.offset},
          {"bytes", row.bytes},
          {"vertices", row.vertices},
          {"faces", row.faces},
          {"max_error", error_json(header, row.max_error)},
          {"rms_error", error_json(header, row.rms_error)}};
}

/// The number, or text, named `key`; nothing if it is of another type.
template <class T>
const T* member(const nlohmann::json& object, const char* key) {
  const auto found = object.find(key);
  return found == object.end() ? nullptr : found->get_ptr<const T*>();
}

}  // namespace

std::string catalogue_json(const std::vector<CatalogueEntry>& entries) {
  Json list = Json::array();
  for (const CatalogueEntry& entry : entries) list.push_back(summary_json(entry));
  return list.dump();
}

std::string mesh_info_json(const CatalogueEntry& entry) {
  const FileHeader& header = entry.index->header;
  Json info = summary_json(entry);
  info["base_faces"] = header.base_faces;
  info["quantization"] = header.lattice.bits;
  info["bbox"] = {{"min", vector_json(header.lattice.position(header.box_low))},
                  {"max", vector_json(header.lattice.position(header.box_high))}};
  Json chunks = Json::array();
  for (const ChunkRow& row : entry.index->chunks) chunks.push_back(chunk_json(header, row));
  info["chunks"] = std::move(chunks);
  info["url"] = file_target(entry.id, header.content_hash);
  return info.dump();
}

Result<MeshInfo> parse_mesh_info(std::string_view json) {
  const auto object = nlohmann::json::parse(json, nullptr, /*allow_exceptions=*/false);
  if (!object.is_object()) return bad_input("mesh info: not a JSON object");
  const auto* id = member<std::string>(object, "id");
  const auto* hash = member<std::string>(object, "hash");
  const auto* file_bytes = member<std::uint64_t>(object, "file_bytes");
  const auto* url = member<std::string>(object, "url");
  if (!id || !hash || !file_bytes || !url) {
    return bad_input("mesh info: id, hash, file_bytes or url is missing");
  }
  const auto parsed_hash = parse_hash(*hash);
  if (!is_mesh_id(*id)) return bad_input("mesh info: id is not a mesh id");
  if (!parsed_hash) return bad_input("mesh info: hash is not 32 hex digits");
  if (!url->starts_with('/')) return bad_input("mesh info: url is not a path");
  return MeshInfo{*id, *parsed_hash, *file_bytes, *url};
}

}  // namespace pmesh
