// A directory to serve with a mesh, one that proxies are told to hide, and secrets beside it.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/server/sample_file.h"

namespace pmesh::testing {

/// What no answer may hold: both files named `secret` do.
inline constexpr const char* kSecret = "the secret beside the meshes";

/// Writes mesh.pmesh, hidden.pmesh and folder/inner.pmesh into `served`; the secrets into `beside`;
/// and links from the one to the other.
inline void write_hostile_files(const std::filesystem::path& served,
                                const std::filesystem::path& beside) {
  const auto write = [](const std::filesystem::path& path, const auto& bytes) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  };
  std::filesystem::create_directories(served / "folder");
  write(served / "mesh.pmesh", make_sample({20'000, 30'000}).bytes);
  write(served / "hidden.pmesh", make_sample({100}, 2).bytes);
  write(served / "folder" / "inner.pmesh", make_sample({100}, 3).bytes);
  SampleFile secret = make_sample({100, 100}, 4);
  const std::string text = kSecret;
  std::ranges::copy(text, secret.bytes.end() - static_cast<std::ptrdiff_t>(text.size()));
  write(beside / "secret.pmesh", secret.bytes);
  write(beside / "secret.txt", text);
  std::filesystem::create_symlink(beside / "secret.pmesh", served / "link.pmesh");
  std::filesystem::create_symlink("../secret.pmesh", served / "folder" / "relative.pmesh");
  std::filesystem::create_directory_symlink(beside, served / "outside");
}

}  // namespace pmesh::testing
