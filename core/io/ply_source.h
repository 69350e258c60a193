// The values of a PLY file's rows, one after another, from text or from bytes: two classes with the
// same members, for the one reader in ply_import.cpp.
//
// Reading never stops in the middle of a row: what is missing or malformed reads as zero (or as an
// empty list) and end_row() reports it.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/bytes.h"
#include "core/io/parsers.h"
#include "core/io/ply_header.h"
#include "core/io/text_scanner.h"

namespace pmesh {

/// One row a line; blank lines are skipped.
class PlyTextSource {
 public:
  explicit PlyTextSource(TextScanner& text) : text_(text) {}

  /// The fewest bytes that a value takes in a row.
  static std::size_t least_bytes(PlyType) { return 2; }  // A digit and a blank or line end.
  static constexpr std::size_t kMissingLineEnd = 1;      // The last line may lack its own.
  std::size_t remaining_bytes() const { return text_.remaining().size(); }

  /// Goes to the next row; fails at the end of the file.
  Status begin_row(const PlyElement& element, std::uint64_t row) {
    found_ = missing_ = 0;
    malformed_.clear();
    while (text_.next_line()) {
      if (!text_.peek().empty()) return {};
    }
    return text_.error("the file ends after " + std::to_string(row) + " of " +
                       std::to_string(element.count) + " rows of " + in_quotes(element.name));
  }

  double number(PlyType) {
    const std::string_view field = next();
    const std::optional<double> value = field.empty() ? 0 : parse_number(field);
    if (!value) note_malformed("expected a number, found " + in_quotes(field));
    return value.value_or(0);
  }
  std::int64_t integer(PlyType) {
    const std::string_view field = next();
    const std::optional<std::int64_t> value = field.empty() ? 0 : parse_integer(field);
    if (!value) note_malformed("expected an integer, found " + in_quotes(field));
    return value.value_or(0);
  }
  void skip(PlyType, std::uint64_t count) {
    // Not one by one past the end of the line: the count may be a lie.
    for (std::uint64_t i = 0; i < count; ++i) {
      if (next().empty()) {
        missing_ += count - i - 1;
        return;
      }
    }
  }
  /// The length of a list whose items are on the line; otherwise 0, noting how many are missing.
  std::uint64_t list_length(const PlyProperty& property) {
    const std::int64_t length = integer(property.count_type);
    if (length < 0) note_malformed("a list's length is " + std::to_string(length));
    if (length <= 0) return 0;
    const auto count = static_cast<std::uint64_t>(length);
    if (2 * count <= text_.rest().size()) return count;
    skip(property.type, count);
    return 0;
  }

  Status end_row(const PlyElement&, std::uint64_t) {
    std::size_t found = found_;
    const std::size_t expected = found_ + missing_;
    if (!malformed_.empty()) return text_.error(malformed_);
    while (!text_.field().empty()) ++found;
    if (found == expected) return {};
    return text_.error("expected " + std::to_string(expected) + " numbers, found " +
                       std::to_string(found));
  }
  /// An error about the row that was read last.
  Error row_error(const PlyElement& element, std::uint64_t row, const std::string& what) const {
    return text_.error(printable(element.name) + " " + std::to_string(row) + ": " + what);
  }
  /// Fails if there is more than padding after the last row.
  Status check_end() {
    if (is_padding(text_.remaining())) return {};
    while (text_.next_line() && text_.peek().empty()) {
    }
    return text_.error("expected the end of the file, found " + in_quotes(text_.peek()));
  }

 private:
  std::string_view next() {
    const std::string_view field = text_.field();
    ++(field.empty() ? missing_ : found_);
    return field;
  }
  void note_malformed(std::string message) {
    if (malformed_.empty()) malformed_ = std::move(message);
  }

  TextScanner& text_;
  std::size_t found_ = 0;    // fields of this row
  std::size_t missing_ = 0;  // values of this row that its line does not have
  std::string malformed_;    // the first malformed field of this row
};

/// Packed values, of either byte order.
template <std::endian kOrder>
class PlyBinarySource {
 public:
  explicit PlyBinarySource(ByteView bytes) : bytes_(bytes) {}

  static std::size_t least_bytes(PlyType type) { return size_of(type); }
  static constexpr std::size_t kMissingLineEnd = 0;
  std::size_t remaining_bytes() const { return bytes_.size(); }

  Status begin_row(const PlyElement&, std::uint64_t) { return {}; }

  double number(PlyType type) {
    switch (type) {
      case PlyType::float32:
        return std::bit_cast<float>(take<std::uint32_t>());
      case PlyType::float64:
        return std::bit_cast<double>(take<std::uint64_t>());
      default:
        return static_cast<double>(integer(type));
    }
  }
  /// Precondition: type is an integer type.
  std::int64_t integer(PlyType type) {
    switch (type) {
      case PlyType::int8:
        return static_cast<std::int8_t>(take<std::uint8_t>());
      case PlyType::uint8:
        return take<std::uint8_t>();
      case PlyType::int16:
        return static_cast<std::int16_t>(take<std::uint16_t>());
      case PlyType::uint16:
        return take<std::uint16_t>();
      case PlyType::int32:
        return static_cast<std::int32_t>(take<std::uint32_t>());
      default:
        return take<std::uint32_t>();
    }
  }
  void skip(PlyType type, std::uint64_t count) {
    if (count > bytes_.size() / size_of(type)) return note("the file ends early");
    bytes_ = bytes_.subspan(count * size_of(type));
  }
  std::uint64_t list_length(const PlyProperty& property) {
    const std::int64_t length = integer(property.count_type);
    if (length < 0) note("a list's length is " + std::to_string(length));
    if (length <= 0) return 0;
    const auto count = static_cast<std::uint64_t>(length);
    if (count <= bytes_.size() / size_of(property.type)) return count;
    note("a list of " + std::to_string(count) + " items, but " + std::to_string(bytes_.size()) +
         " bytes follow");
    return 0;
  }

  Status end_row(const PlyElement& element, std::uint64_t row) {
    if (problem_.empty()) return {};
    return row_error(element, row, problem_);
  }
  Error row_error(const PlyElement& element, std::uint64_t row, const std::string& what) const {
    return bad_input(printable(element.name) + " " + std::to_string(row) + ": " + what);
  }
  Status check_end() const {
    if (is_padding(bytes_)) return {};
    return bad_input(std::to_string(bytes_.size()) + " bytes follow the last element");
  }

 private:
  template <std::unsigned_integral T>
  T take() {
    if (bytes_.size() < sizeof(T)) {
      note("the file ends early");
      bytes_ = {};
      return 0;
    }
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      const std::size_t place = kOrder == std::endian::little ? i : sizeof(T) - 1 - i;
      value |= std::uint64_t{bytes_[i]} << (8 * place);
    }
    bytes_ = bytes_.subspan(sizeof(T));
    return static_cast<T>(value);
  }
  void note(std::string problem) {
    if (problem_.empty()) problem_ = std::move(problem);
  }

  ByteView bytes_;
  std::string problem_;  // the first one
};

}  // namespace pmesh
