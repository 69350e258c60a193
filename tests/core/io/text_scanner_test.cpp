#include "core/io/text_scanner.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace pmesh {
namespace {

TEST(ParseNumber, GivesTheNearestDouble) {
  EXPECT_EQ(parse_number("0.1"), 0.1);
  EXPECT_EQ(parse_number("+1.5e3"), 1500.0);
  EXPECT_EQ(parse_number("-.5"), -0.5);
  EXPECT_EQ(parse_number("5000000.123456789"), 5000000.123456789);
  EXPECT_EQ(parse_number("4.9e-324"), 4.9e-324);
}

TEST(ParseNumber, GivesInfinityOrZeroBeyondDoubles) {
  EXPECT_EQ(parse_number("1e309"), HUGE_VAL);
  EXPECT_EQ(parse_number("-1e999"), -HUGE_VAL);
  EXPECT_EQ(parse_number("1e-999"), 0.0);
  EXPECT_EQ(parse_number("0." + std::string(2000, '0') + "1"), 0.0);
}

TEST(ParseNumber, TakesAMillionDigits) {
  EXPECT_EQ(parse_number("0." + std::string(1'000'000, '3')), 1.0 / 3);
}

TEST(ParseNumber, RefusesWhatIsNotWhollyANumber) {
  for (const char* field : {"", "+", "-", "+-1", "1.5f", "1,5", "0x1p3", "1.#QNAN", "one"}) {
    EXPECT_EQ(parse_number(field), std::nullopt) << field;
  }
}

TEST(ParseInteger, RefusesWhatIsNotWhollyAnInteger) {
  EXPECT_EQ(parse_integer("+12"), 12);
  EXPECT_EQ(parse_integer("-12"), -12);
  for (const char* field : {"", "+", "1.0", "1e3", "9223372036854775808", "0x1"}) {
    EXPECT_EQ(parse_integer(field), std::nullopt) << field;
  }
}

TEST(Printable, ShortensAndReplaces) {
  EXPECT_EQ(in_quotes("a\tb\xff"), "'a?b?'");
  EXPECT_EQ(in_quotes(std::string(100, 'x')), "'" + std::string(24, 'x') + "...'");
}

TEST(TextScanner, CountsLines) {
  TextScanner text(as_bytes("one\n\n# comment\n two\r\n"));
  ASSERT_TRUE(text.next_filled_line());
  EXPECT_EQ(text.line(), 1u);
  ASSERT_TRUE(text.next_filled_line());
  EXPECT_EQ(text.field(), "two");
  EXPECT_EQ(text.line(), 4u);
  EXPECT_FALSE(text.next_line());
}

TEST(TextScanner, SplitsFieldsAtBlanks) {
  TextScanner text(as_bytes("  a\t b  \r\n"));
  ASSERT_TRUE(text.next_line());
  EXPECT_EQ(text.field(), "a");
  EXPECT_EQ(text.peek(), "b");
  EXPECT_EQ(text.field(), "b");
  EXPECT_EQ(text.field(), "");
}

TEST(TextScanner, JoinsContinuedLinesUpToTheEndOfTheText) {
  TextScanner text(as_bytes("a \\\nb\\\n"));
  ASSERT_TRUE(text.next_line());
  text.join_continued_lines();
  EXPECT_EQ(text.field(), "a");
  EXPECT_EQ(text.field(), "b");
  EXPECT_EQ(text.field(), "");
  EXPECT_EQ(text.line(), 1u);
  EXPECT_FALSE(text.next_line());
}

TEST(TextScanner, SaysHowManyNumbersAreMissing) {
  TextScanner text(as_bytes("\n1 2"));
  text.next_filled_line();
  std::array<double, 3> numbers{};
  EXPECT_EQ(text.read_numbers(numbers).error().message, "line 2: expected 3 numbers, found 2");
}

}  // namespace
}  // namespace pmesh
