// Linear equations, for the encoder's fits.
#pragma once

#include <array>
#include <cstddef>

namespace pmesh {

template <std::size_t N>
using Row = std::array<double, N>;
template <std::size_t N>
using SquareMatrix = std::array<Row<N>, N>;

/// The solution of a x = b by Gaussian elimination, for a positive semi-definite a.
template <std::size_t N>
Row<N> solve(SquareMatrix<N> a, Row<N> b) {
  for (std::size_t i = 0; i < N; ++i) {
    a[i][i] += 1e-9;
    for (std::size_t j = i + 1; j < N; ++j) {
      const double factor = a[j][i] / a[i][i];
      for (std::size_t k = i; k < N; ++k) a[j][k] -= factor * a[i][k];
      b[j] -= factor * b[i];
    }
  }
  for (std::size_t i = N; i-- > 0;) {
    for (std::size_t k = i + 1; k < N; ++k) b[i] -= a[i][k] * b[k];
    b[i] /= a[i][i];
  }
  return b;
}

}  // namespace pmesh
