// A line on stderr that is drawn again and again, for terminals only.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace pmesh::cli {

class ProgressBar {
 public:
  /// Draws only if `wanted` and stderr is a terminal.
  explicit ProgressBar(bool wanted);
  ~ProgressBar() { end_line(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Shows done/total (total 0: not known) and `note` behind it; at most ten times a second.
  void show(std::uint64_t done, std::uint64_t total, const std::string& note);

  /// Leaves the line as it stands; call it before anything else is printed. The next show() draws
  /// on a line of its own.
  void end_line();

 private:
  bool is_on_;
  bool has_drawn_ = false;
  std::chrono::steady_clock::time_point next_{};
};

/// The text of one line, without moving the cursor: "[=====>    ]  50%  note".
std::string progress_line(std::uint64_t done, std::uint64_t total, const std::string& note);

}  // namespace pmesh::cli
