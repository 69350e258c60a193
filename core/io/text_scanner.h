// Walks a text line by line, and each line field by field, counting lines for error messages.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/base/bytes.h"
#include "core/base/result.h"

namespace pmesh {

/// The whole of `field` as a number, nearest double, whatever the locale; a leading '+' is
/// allowed. Numbers too large for a double give an infinity, too small ones zero.
std::optional<double> parse_number(std::string_view field);

/// The whole of `field` as a decimal integer; a leading '+' is allowed.
std::optional<std::int64_t> parse_integer(std::string_view field);

/// Whether two words are equal but for ASCII case.
bool same_word(std::string_view a, std::string_view b);

/// `text` for a message: shortened, bytes that do not print replaced.
std::string printable(std::string_view text);
std::string in_quotes(std::string_view text);

/// "line 12: " and `message`, as bad_input.
Error line_error(std::size_t line, const std::string& message);

/// Lines end in LF or CRLF, or, if the first line does, in CR alone. Fields are separated by blanks
/// and tabs. A UTF-8 byte order mark is skipped. The text must outlive the scanner.
class TextScanner {
 public:
  explicit TextScanner(ByteView text);

  /// Goes to the next line; false at the end of the text.
  bool next_line();
  /// Goes to the next line that holds a field and does not begin with '#'.
  bool next_filled_line();
  /// If the line ends with a backslash, adds the lines that it goes on in, with a blank between.
  void join_continued_lines();

  /// The next field of the line; empty at its end.
  std::string_view field();
  /// What field() would give, without going past it.
  std::string_view peek() const;
  /// The part of the line that is not yet read.
  std::string_view rest() const { return rest_; }

  /// Reads out.size() finite numbers, or fails: "line 12: expected 3 numbers, found 2".
  Status read_numbers(std::span<double> out);

  /// line_error() of the current line.
  Error error(const std::string& message) const { return line_error(line(), message); }

  /// The number of the current line, from 1; of the first, if lines were joined.
  std::size_t line() const { return line_ == 0 ? 1 : line_; }

  /// All bytes after this line.
  ByteView remaining() const { return as_bytes(text_); }

 private:
  std::string_view text_;  // after the current line
  std::string_view rest_;  // of the current line
  std::string joined_;     // holds the line that join_continued_lines() made
  std::size_t line_ = 0;
  std::size_t lines_joined_ = 0;  // to the current line
  char line_end_ = '\n';
};

}  // namespace pmesh
