#include "cli/wish_options.h"

#include <optional>

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

#include "cli/progress_bar.h"

namespace pmesh::cli {
namespace {

// The wish that a command line gives; nothing if the parser refuses it.
std::optional<LodRequest> parsed(const std::string& line) {
  CLI::App app;
  WishOptions options;
  options.add_to(app);
  try {
    app.parse(line);
  } catch (const CLI::ParseError&) {
    return std::nullopt;
  }
  return options.wish();
}

TEST(WishOptions, SpellWishesAsTheHttpQueryDoes) {
  EXPECT_EQ(parsed(""), *parse_wish(""));
  EXPECT_EQ(parsed("--faces 1000"), *parse_wish("faces=1000"));
  EXPECT_EQ(parsed("--vertices=7"), *parse_wish("vertices=7"));
  EXPECT_EQ(parsed("--ratio 0.05"), *parse_wish("ratio=0.05"));
  EXPECT_EQ(parsed("--bytes 65536"), *parse_wish("bytes=65536"));
  EXPECT_EQ(parsed("--error 0.25"), *parse_wish("error=0.25"));
  EXPECT_EQ(parsed("--error 0.1%"), *parse_wish("error=0.1%"));
}

TEST(WishOptions, RefuseASecondWish) {
  EXPECT_FALSE(parsed("--faces 1000 --ratio 0.5"));
  EXPECT_FALSE(parsed("--bytes 1 --vertices 1"));
  EXPECT_FALSE(parsed("--error 1 --bytes 1"));
}

TEST(WishOptions, RefuseValuesOutOfRange) {
  for (const char* line :
       {"--faces -1", "--faces 1.5", "--faces x", "--faces 99999999999999999999", "--ratio 0",
        "--ratio 1.01", "--ratio nan", "--bytes 1k", "--faces", "--error -1", "--error=-1",
        "--error nan", "--error inf", "--error 1%%", "--error 1mm", "--error"}) {
    EXPECT_FALSE(parsed(line)) << line;
  }
}

TEST(ProgressLine, FillsWithTheShare) {
  EXPECT_EQ(progress_line(0, 10, "x"), "[>                             ]   0%  x");
  EXPECT_EQ(progress_line(5, 10, "x"), "[===============>              ]  50%  x");
  EXPECT_EQ(progress_line(10, 10, "x"), "[==============================] 100%  x");
}

TEST(ProgressLine, StaysEmptyWhileTheTotalIsNotKnownAndFullBeyondIt) {
  EXPECT_EQ(progress_line(10, 0, "x"), progress_line(0, 10, "x"));
  EXPECT_EQ(progress_line(11, 10, "x"), progress_line(10, 10, "x"));
}

}  // namespace
}  // namespace pmesh::cli
