#include "core/pm/fit_parameters.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace pmesh {
namespace {

constexpr double kUnit = 32;          // weights are in 1/32
constexpr double kDrawn = 10;         // the old weights count as much as this many splits
constexpr double kBitsOfChange = 10;  // a changed weight costs about this many bits

Vec3d widen(Vec3l a) {
  return {static_cast<double>(a.x), static_cast<double>(a.y), static_cast<double>(a.z)};
}

// The solution of a x = b by Gaussian elimination, for a positive definite a.
template <std::size_t N>
std::array<double, N> solved(std::array<std::array<double, N>, N> a, std::array<double, N> b) {
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

// Least squares for N weights.
template <std::size_t N>
class Fit {
 public:
  using Row = std::array<double, N>;

  // A sample of `features`, the dot products of which with each other and with what is wanted are
  // given by `product`.
  template <class Product>
  void add(const std::array<Vec3d, N>& features, Vec3d wanted, double weight, Product product) {
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t j = 0; j < N; ++j)
        squares_[i][j] += weight * product(features[i], features[j]);
      moments_[i] += weight * product(features[i], wanted);
    }
    energy_ += weight * product(wanted, wanted);
    samples_ += 1;
  }

  // Replaces `weights` if that saves bits; `dimensions` of the residual.
  void solve(std::array<std::int64_t, N>& weights, double dimensions) const {
    if (samples_ == 0) return;
    Row before{};
    for (std::size_t i = 0; i < N; ++i) before[i] = static_cast<double>(weights[i]) / kUnit;
    Row solved = eliminate(before);
    for (double& weight : solved) {
      weight = std::round(std::fmin(std::fmax(weight * kUnit, -double{kMostWeight}),
                                    double{kMostWeight})) /
               kUnit;
    }
    const double floor = 0.05 * samples_ / 64;  // residuals are not finer than rounding
    const double saved = samples_ * dimensions / 2 *
                         std::log2((residual(before) + floor) / (residual(solved) + floor));
    if (!(saved > kBitsOfChange * double{N})) return;
    for (std::size_t i = 0; i < N; ++i) {
      weights[i] = static_cast<std::int64_t>(std::lround(solved[i] * kUnit));
    }
  }

 private:
  double residual(const Row& x) const {
    double sum = energy_;
    for (std::size_t i = 0; i < N; ++i) {
      sum -= 2 * x[i] * moments_[i];
      for (std::size_t j = 0; j < N; ++j) sum += x[i] * x[j] * squares_[i][j];
    }
    return std::fmax(sum, 0);
  }

  Row eliminate(const Row& before) const {
    std::array<Row, N> a = squares_;
    Row b = moments_;
    for (std::size_t i = 0; i < N; ++i) {
      const double drawn = kDrawn / samples_ * a[i][i];
      a[i][i] += drawn;
      b[i] += drawn * before[i];
    }
    return solved(a, b);
  }

  std::array<Row, N> squares_{};
  Row moments_{};
  double energy_ = 0, samples_ = 0;
};

// The fits of one kind of fan.
struct FanFit {
  Fit<4> tangential;
  Fit<2> normal;

  void add(const Patch& patch, Vec3d wanted, double weight) {
    const Vec3d n =
        (1 / std::sqrt(static_cast<double>(patch.normal_squared))) * widen(patch.normal);
    const auto along = [&](Vec3d a, Vec3d b) { return dot(a, n) * dot(b, n); };
    const auto across = [&](Vec3d a, Vec3d b) { return dot(a, b) - along(a, b); };
    const auto& f = patch.features;
    tangential.add({widen(f[0]), widen(f[1]), widen(f[2]), widen(f[3])}, wanted, weight, across);
    normal.add({widen(f[0]), widen(f[2])}, wanted, weight, along);
  }

  void solve(Predictor::Weights& weights) const {
    tangential.solve(weights.tangential, 2);
    normal.solve(weights.normal, 1);
  }
};

struct MirrorFit {
  Fit<1> tangential, normal;

  void add(const Patch& patch, Vec3d back, Vec3d wanted, double weight) {
    const Vec3d n =
        (1 / std::sqrt(static_cast<double>(patch.normal_squared))) * widen(patch.normal);
    const auto along = [&](Vec3d a, Vec3d b) { return dot(a, n) * dot(b, n); };
    const auto across = [&](Vec3d a, Vec3d b) { return dot(a, b) - along(a, b); };
    tangential.add({back}, wanted, weight, across);
    normal.add({back}, wanted, weight, along);
  }
};

// A logistic choice among a ring's candidates: the likelihood of the weights, its slope and its
// curvature, as they add up over a batch.
struct FanFitStep {
  double log_likelihood = 0;
  std::array<double, 3> slope{};
  std::array<std::array<double, 3>, 3> curvature{};

  void add(const VertexRing& ring, std::span<const VertexRing::Candidate> candidates,
           std::uint32_t length, std::uint32_t chosen) {
    const auto lead = [&](const VertexRing::Candidate& c) {
      return static_cast<double>(ring.lead(c, candidates[0], 64)) / (64 * 16);
    };
    double total = 0;
    for (const auto& c : candidates) total += std::exp(lead(c));
    std::array<double, 3> mean{};
    std::array<std::array<double, 3>, 3> squares{};
    for (const auto& c : candidates) {
      const double chance = std::exp(lead(c)) / total;
      const std::array<double, 3> x = scaled(ring, c.first, length);
      for (std::size_t i = 0; i < 3; ++i) {
        mean[i] += chance * x[i];
        for (std::size_t j = 0; j < 3; ++j) squares[i][j] += chance * x[i] * x[j];
        if (c.first == chosen) slope[i] += x[i];
      }
      if (c.first == chosen) log_likelihood += std::log(chance);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      slope[i] -= mean[i];
      for (std::size_t j = 0; j < 3; ++j) curvature[i][j] += squares[i][j] - mean[i] * mean[j];
    }
  }

 private:
  static std::array<double, 3> scaled(const VertexRing& ring, std::uint32_t first,
                                      std::uint32_t length) {
    const std::array<std::int64_t, 3> of = ring.terms(first, length);
    const double unit = 16 * static_cast<double>(ring.score_unit());
    return {static_cast<double>(of[0]) / unit, static_cast<double>(of[1]) / unit,
            static_cast<double>(of[2]) / unit};
  }
};

FanFitStep measure_fans(const RefinableMesh& mesh, std::span<const BatchSplit> batch,
                        const std::vector<std::uint8_t>& nothing_covered,
                        const FanWeights& weights) {
  constexpr std::size_t kSample = 4000;
  FanFitStep step;
  VertexRing ring;
  const std::size_t stride = 1 + batch.size() / kSample;
  for (std::size_t s = 0; s < batch.size(); s += stride) {
    const SplitSite& site = batch[s].split.site;
    if (site.kind != SplitKind::interior) continue;
    if (!ring.gather(mesh, kept_vertex(mesh.connectivity(), site))) continue;
    if (ring.find_runs(nothing_covered) < site.moved_faces) continue;
    const auto candidates = ring.rank(mesh, site.moved_faces, weights);
    std::uint32_t chosen = 0;
    while (ring.half_edge(chosen) != site.half_edge) ++chosen;
    step.add(ring, candidates, site.moved_faces, chosen);
  }
  return step;
}

// Newton's method from the weights before.
FanWeights fit_fans(const RefinableMesh& mesh, std::span<const BatchSplit> batch,
                    const FanWeights& before) {
  constexpr int kSteps = 3;
  constexpr double kWorth = 3 * kBitsOfChange * 0.7;  // in natural logarithms
  const std::vector<std::uint8_t> nothing_covered(mesh.face_count());
  FanWeights best = before, at = before;
  double likelihood = 0, best_likelihood = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const FanFitStep step = measure_fans(mesh, batch, nothing_covered, at);
    likelihood = step.log_likelihood;
    if (i == 0) best_likelihood = likelihood + kWorth;
    if (likelihood > best_likelihood) {
      best_likelihood = likelihood;
      best = at;
    }
    const std::array<double, 3> change = solved(step.curvature, step.slope);
    for (std::size_t k = 0; k < 3; ++k) {
      at.of[k] = clamp_to(at.of[k] + std::lround(change[k]), kMostWeight);
    }
  }
  return best;
}

}  // namespace

BatchParameters fit_parameters(const RefinableMesh& mesh, std::span<const BatchSplit> batch,
                               const BatchParameters& before) {
  FanFit small, large, border;
  MirrorFit mirrored;
  Patch patch;
  for (const BatchSplit& entry : batch) {
    patch.gather(mesh, entry.split.site);
    const Vec3l added = patch.local(entry.split.position);
    const double weight = 1 / (static_cast<double>(patch.radius_squared) + 64);
    FanFit& fan = patch.kind != SplitKind::interior ? border
                  : patch.faces <= kSmallFan        ? small
                                                    : large;
    fan.add(patch, widen(added - patch.centroid), weight);
    mirrored.add(patch, widen(Vec3l{} - added),
                 widen(patch.local(patch.kept + entry.split.relocation)), weight);
  }
  BatchParameters fitted = before;
  small.solve(fitted.predictor.small);
  large.solve(fitted.predictor.large);
  border.solve(fitted.predictor.border);
  std::array<std::int64_t, 1> tangential = {fitted.predictor.mirrored[0]};
  std::array<std::int64_t, 1> normal = {fitted.predictor.mirrored[1]};
  mirrored.tangential.solve(tangential, 2);
  mirrored.normal.solve(normal, 1);
  fitted.predictor.mirrored = {tangential[0], normal[0]};
  fitted.fan = fit_fans(mesh, batch, before.fan);
  return fitted;
}

}  // namespace pmesh
