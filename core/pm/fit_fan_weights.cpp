#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/pm/fit_parameters.h"
#include "core/pm/solve.h"

namespace pmesh {
namespace {

constexpr std::size_t kMostSamples = 1000;
constexpr int kSteps = 3;

// Logistic choices: each of one of a vertex's candidates.
class Choices {
 public:
  // What a weight of one adds to a candidate's score, in natural logarithms.
  using Terms = Row<3>;

  void begin() { ends_.push_back(terms_.size()); }
  void add(const Terms& terms, bool is_chosen) {
    if (is_chosen) chosen_.push_back(terms_.size());
    terms_.push_back(terms);
    ends_.back() = terms_.size();
  }

  // The logarithm of the likelihood of `weights`, its slope, and its curvature's negative.
  struct Likelihood {
    double logarithm = 0;
    Row<3> slope{};
    SquareMatrix<3> curvature{};
  };
  Likelihood likelihood(const FanWeights& weights) const {
    Likelihood all;
    for (std::size_t i = 0, begin = 0; i < ends_.size(); begin = ends_[i++]) {
      add_choice(weights, begin, ends_[i], terms_[chosen_[i]], all);
    }
    return all;
  }

 private:
  static double score(const FanWeights& weights, const Terms& terms) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += static_cast<double>(weights.of[k]) * terms[k];
    return sum;
  }

  void add_choice(const FanWeights& weights, std::size_t begin, std::size_t end,
                  const Terms& chosen, Likelihood& all) const {
    const double chosen_score = score(weights, chosen);
    double total = 0;
    Row<3> mean{};
    SquareMatrix<3> squares{};
    for (std::size_t c = begin; c < end; ++c) {
      const double share = std::exp(score(weights, terms_[c]) - chosen_score);
      total += share;
      for (std::size_t i = 0; i < 3; ++i) {
        mean[i] += share * terms_[c][i];
        for (std::size_t j = 0; j <= i; ++j) squares[i][j] += share * terms_[c][i] * terms_[c][j];
      }
    }
    all.logarithm -= std::log(total);
    for (std::size_t i = 0; i < 3; ++i) {
      all.slope[i] += chosen[i] - mean[i] / total;
      for (std::size_t j = 0; j < 3; ++j) {
        const double square = squares[i > j ? i : j][i > j ? j : i] / total;
        all.curvature[i][j] += square - mean[i] / total * (mean[j] / total);
      }
    }
  }

  std::vector<Terms> terms_;         // by candidate
  std::vector<std::size_t> ends_;    // by choice: of its candidates
  std::vector<std::size_t> chosen_;  // by choice
};

void add_choice(const VertexRing& ring, const SplitSite& site, Choices& choices) {
  const double unit = 16 * static_cast<double>(ring.score_unit());
  choices.begin();
  for (const VertexRing::Candidate candidate : ring.candidates()) {
    const std::uint32_t first = VertexRing::first_face(candidate);
    const std::array<std::int64_t, 3> of = ring.terms(first);
    choices.add({static_cast<double>(of[0]) / unit, static_cast<double>(of[1]) / unit,
                 static_cast<double>(of[2]) / unit},
                ring.half_edge(first) == site.half_edge);
  }
}

Choices gather(const RefinableMesh& mesh, std::span<const BatchSplit> batch) {
  const std::vector<std::uint8_t> nothing_covered(mesh.face_count());
  Choices choices;
  VertexRing ring;
  for (std::size_t s = 0; s < batch.size(); s += 1 + batch.size() / kMostSamples) {
    const SplitSite& site = batch[s].split.site;
    if (site.kind != SplitKind::interior || !ring.gather(mesh, batch[s].kept, nothing_covered)) {
      continue;
    }
    if (ring.find_runs() < site.moved_faces) continue;
    ring.score(site.moved_faces, {});
    add_choice(ring, site, choices);
  }
  return choices;
}

}  // namespace

// Newton's method from the weights before.
FanWeights fit_fan_weights(const RefinableMesh& mesh, std::span<const BatchSplit> batch,
                           const FanWeights& before) {
  const double kWorth = 3 * kBitsOfChange * std::log(2.0);
  const Choices choices = gather(mesh, batch);
  FanWeights best = before, at = before;
  double best_logarithm = 0;
  for (int step = 0; step <= kSteps; ++step) {
    const Choices::Likelihood now = choices.likelihood(at);
    if (step == 0) best_logarithm = now.logarithm + kWorth;
    if (now.logarithm > best_logarithm) {
      best_logarithm = now.logarithm;
      best = at;
    }
    const Row<3> change = solve(now.curvature, now.slope);
    for (std::size_t k = 0; k < 3; ++k) {
      at.of[k] = clamp_to(at.of[k] + std::lround(change[k]), kMostWeight);
    }
  }
  return best;
}

}  // namespace pmesh
