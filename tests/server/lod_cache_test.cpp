#include "server/lod/lod_cache.h"

#include <gtest/gtest.h>

namespace pmesh {
namespace {

LodKey key(const std::string& wish) { return {.wish = wish}; }

LodFilePtr file_of(std::size_t bytes) {
  return std::make_shared<const LodFile>(LodFile{.bytes = Bytes(bytes)});
}

TEST(LodCache, FindsWhatWasPut) {
  LodCache cache(100);
  const LodFilePtr file = file_of(40);
  cache.put(key("a"), file);
  EXPECT_EQ(cache.find(key("a")), file);
  EXPECT_EQ(cache.find(key("b")), nullptr);
  EXPECT_EQ(cache.bytes(), 40u);
}

TEST(LodCache, TellsKeysApartByEveryPart) {
  LodCache cache(100);
  cache.put(key("a"), file_of(1));
  EXPECT_EQ(cache.find({.hash = {1}, .wish = "a"}), nullptr);
  EXPECT_EQ(cache.find({.format = LodFormat::drc, .wish = "a"}), nullptr);
  EXPECT_EQ(cache.find({.wish = "a", .reached = false}), nullptr);
}

TEST(LodCache, DropsWhatWasAskedForLeastRecently) {
  LodCache cache(100);
  for (const char* name : {"a", "b", "c"}) cache.put(key(name), file_of(30));
  cache.find(key("a"));
  cache.put(key("d"), file_of(60));
  EXPECT_NE(cache.find(key("a")), nullptr);
  EXPECT_EQ(cache.find(key("b")), nullptr);
  EXPECT_EQ(cache.find(key("c")), nullptr);
  EXPECT_EQ(cache.bytes(), 90u);
}

TEST(LodCache, KeepsNothingThatIsLargerThanItself) {
  LodCache cache(100);
  cache.put(key("a"), file_of(100));
  cache.put(key("b"), file_of(101));
  EXPECT_NE(cache.find(key("a")), nullptr);
  EXPECT_EQ(cache.find(key("b")), nullptr);
}

TEST(LodCache, OfNoBytesKeepsNothing) {
  LodCache cache(0);
  cache.put(key("a"), file_of(1));
  EXPECT_EQ(cache.find(key("a")), nullptr);
  EXPECT_EQ(cache.bytes(), 0u);
}

}  // namespace
}  // namespace pmesh
