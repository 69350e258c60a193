#include "cli/progress_bar.h"

#include <algorithm>
#include <cstdio>

#include <unistd.h>

namespace pmesh::cli {

ProgressBar::ProgressBar(bool wanted) : is_on_(wanted && ::isatty(STDERR_FILENO) == 1) {}

void ProgressBar::end_line() {
  if (has_drawn_) std::fputc('\n', stderr);
  has_drawn_ = false;
}

void ProgressBar::show(std::uint64_t done, std::uint64_t total, const std::string& note) {
  const auto now = std::chrono::steady_clock::now();
  const bool is_last = total > 0 && done >= total;
  if (!is_on_ || (now < next_ && !is_last)) return;
  next_ = now + std::chrono::milliseconds(100);
  has_drawn_ = true;
  // Back to the line's start; clear it from there.
  std::fprintf(stderr, "\r\x1b[K%s", progress_line(done, total, note).c_str());
  std::fflush(stderr);
}

std::string progress_line(std::uint64_t done, std::uint64_t total, const std::string& note) {
  constexpr std::size_t kWidth = 30;
  const double share =
      total == 0 ? 0 : std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
  const auto filled = static_cast<std::size_t>(share * kWidth);
  std::string bar(filled, '=');
  bar.resize(kWidth, ' ');
  if (filled < kWidth) bar[filled] = '>';
  char percent[8];
  std::snprintf(percent, sizeof percent, "%3d%%", static_cast<int>(100 * share));
  return "[" + bar + "] " + percent + "  " + note;
}

}  // namespace pmesh::cli
