#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/pm/fit_parameters.h"
#include "core/pm/solve.h"

namespace pmesh {
namespace {

constexpr std::size_t kMostSamples = 2000;
constexpr int kPasses = 6;
constexpr double kUnit = 32;               // weights are in 1/32
constexpr double kDrawn = 5;               // the weights before count as much as this many samples
constexpr double kRounding = 0.25;         // residuals are not finer, in squared lattice steps
constexpr double kFinestResidual = 0.003;  // nor than this share of what may be expected

Vec3d widen(Vec3l a) {
  return {static_cast<double>(a.x), static_cast<double>(a.y), static_cast<double>(a.z)};
}

// Of N weights of the same kind the best for the samples.
template <std::size_t N>
class WeightSearch {
 public:
  using Weights = std::array<std::int64_t, N>;

  // A sample of features and what they should add up to. `product` says which parts of vectors
  // count; `step` and `spread` are the squares of the lattice's step and of the residual to expect.
  template <class Product>
  void add(const std::array<Vec3d, N>& features, Vec3d wanted, double step, double spread,
           Product product) {
    Sample& sample = samples_.emplace_back();
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t j = 0; j < N; ++j) {
        sample.squares[i][j] = product(features[i], features[j]) / (kUnit * kUnit);
      }
      sample.moments[i] = product(features[i], wanted) / kUnit;
    }
    sample.energy = product(wanted, wanted);
    sample.step = step;
    sample.finest = kRounding * step + kFinestResidual * spread;
  }

  // Residuals have that many dimensions. In every pass the weights tried last get their cost in
  // bits, and the next ones are fitted. A residual costs its logarithm, so a sample weighs the less
  // in the fit the worse it was predicted.
  Weights find(const Weights& before, double dimensions) const {
    Weights tried = before, best = before;
    double least_bits = std::numeric_limits<double>::infinity();
    for (int pass = 0; pass < kPasses && !samples_.empty(); ++pass) {
      double bits = tried == before ? 0 : kBitsOfChange * double{N};
      const Weights next = fit(tried, dimensions, bits);
      if (bits < least_bits) {
        least_bits = bits;
        best = tried;
      }
      tried = next;
    }
    return best;
  }

 private:
  struct Sample {
    SquareMatrix<N> squares;
    Row<N> moments;
    double energy, step, finest;

    // The square of what `weights` leave of what is wanted.
    double residual(const Row<N>& weights) const {
      double sum = energy;
      for (std::size_t i = 0; i < N; ++i) {
        double product = -2 * moments[i];
        for (std::size_t j = 0; j < N; ++j) product += weights[j] * squares[i][j];
        sum += weights[i] * product;
      }
      return std::fmax(sum, 0);
    }
  };

  Weights fit(const Weights& tried, double dimensions, double& bits) const {
    Row<N> now;
    for (std::size_t i = 0; i < N; ++i) now[i] = static_cast<double>(tried[i]);
    SquareMatrix<N> squares{};
    Row<N> moments{};
    for (const Sample& sample : samples_) {
      const double residual = sample.residual(now);
      bits += dimensions / 2 * std::log2(residual / sample.step + kRounding);
      const double weight = 1 / (residual + sample.finest);
      for (std::size_t i = 0; i < N; ++i) {
        for (std::size_t j = 0; j < N; ++j) squares[i][j] += weight * sample.squares[i][j];
        moments[i] += weight * sample.moments[i];
      }
    }
    for (std::size_t i = 0; i < N; ++i) {
      const double drawn = kDrawn / static_cast<double>(samples_.size()) * squares[i][i];
      squares[i][i] += drawn;
      moments[i] += drawn * now[i];
    }
    return rounded(solve(squares, moments));
  }

  static Weights rounded(const Row<N>& weights) {
    constexpr double kMost{kMostWeight};
    Weights whole;
    for (std::size_t i = 0; i < N; ++i) {
      whole[i] = std::lround(std::fmin(std::fmax(weights[i], -kMost), kMost));
    }
    return whole;
  }

  std::vector<Sample> samples_;
};

// The tangential and the normal weights of one class of fans, or of relocations.
template <std::size_t T, std::size_t N>
struct PartSearch {
  WeightSearch<T> tangential;
  WeightSearch<N> normal;

  void add(const Patch& patch, const std::array<Vec3d, T>& tangential_features,
           const std::array<Vec3d, N>& normal_features, Vec3d wanted,
           const Prediction& prediction) {
    const Vec3d n =
        (1 / std::sqrt(static_cast<double>(patch.normal_squared))) * widen(patch.normal);
    const auto along = [&](Vec3d a, Vec3d b) { return dot(a, n) * dot(b, n); };
    const auto across = [&](Vec3d a, Vec3d b) { return dot(a, b) - along(a, b); };
    const double step = std::ldexp(64, -2 * patch.shift);
    const auto spread = [&](int magnitude) { return std::ldexp(1, magnitude - 2 * patch.shift); };
    tangential.add(tangential_features, wanted, step, spread(prediction.tangential_class), across);
    normal.add(normal_features, wanted, step, spread(prediction.normal_class), along);
  }
};

}  // namespace

Predictor fit_predictor(const RefinableMesh& mesh, std::span<const BatchSplit> batch,
                        const Predictor& before) {
  std::array<PartSearch<4, 2>, kFanClasses> fans;
  PartSearch<1, 1> mirrored;
  Fan fan;
  Patch patch;
  for (std::size_t s = 0; s < batch.size(); s += 1 + batch.size() / kMostSamples) {
    const VertexSplit& split = batch[s].split;
    fan.walk(mesh.connectivity(), split.site);
    patch.gather(mesh, fan);
    const Vec3d added = widen(patch.local(split.position));
    const std::array<Vec3d, 4> features = {widen(patch.features[0]), widen(patch.features[1]),
                                           widen(patch.features[2]), widen(patch.features[3])};
    fans[patch.fan_class()].add(patch, features, {features[0], features[2]},
                                added - widen(patch.centroid), predict(patch, before));
    if (split.relocation == Vec3i{}) continue;
    const Vec3d back = Vec3d{} - added;
    mirrored.add(patch, {back}, {back}, widen(patch.local(patch.kept + split.relocation)),
                 predict_kept(patch, before, split.position));
  }
  Predictor found;
  for (std::size_t i = 0; i < kFanClasses; ++i) {
    found.fans[i] = {fans[i].tangential.find(before.fans[i].tangential, 2),
                     fans[i].normal.find(before.fans[i].normal, 1)};
  }
  found.mirrored = {mirrored.tangential.find({before.mirrored[0]}, 2)[0],
                    mirrored.normal.find({before.mirrored[1]}, 1)[0]};
  return found;
}

}  // namespace pmesh
