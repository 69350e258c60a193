// What is known of the error of each face of a level of detail (LOD): bounds that hold, not
// samples.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace pmesh {

/// By face of an LOD, in unit lengths (core/measure/surface.h). Every point of the original surface
/// is charged to a face of the LOD, or to several.
struct FaceErrors {
  std::vector<double> to_original;    ///< No point of the face is farther from the original.
  std::vector<double> from_original;  ///< No point charged to the face is farther from the face.

  /// Nothing is known.
  explicit FaceErrors(std::size_t faces = 0)
      : to_original(faces, std::numeric_limits<double>::infinity()), from_original(to_original) {}

  std::uint32_t size() const { return static_cast<std::uint32_t>(to_original.size()); }
  void resize(std::size_t faces) {
    to_original.resize(faces);
    from_original.resize(faces);
  }
};

}  // namespace pmesh
