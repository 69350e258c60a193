// A small 3-vector: double for geometry, int32 for positions on the lattice.
#pragma once

#include <cmath>
#include <cstdint>

namespace pmesh {

template <class T>
struct Vec3 {
  T x{}, y{}, z{};

  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
  friend constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr Vec3 operator*(T s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
  constexpr Vec3& operator+=(Vec3 b) { return *this = *this + b; }
};

using Vec3d = Vec3<double>;
using Vec3i = Vec3<std::int32_t>;

template <class T>
constexpr T dot(Vec3<T> a, Vec3<T> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class T>
constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline double length(Vec3d a) { return std::sqrt(dot(a, a)); }

}  // namespace pmesh
