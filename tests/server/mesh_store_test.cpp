#include "server/mesh_store.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "tests/fixtures/temporary_directory.h"
#include "tests/server/sample_file.h"

namespace pmesh {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using testing::make_sample;
using testing::SampleFile;

class MeshStoreTest : public ::testing::Test {
 protected:
  void open() { store_ = MeshStore::open(directory_ / "", milliseconds(0)).value(); }

  std::vector<std::string> listed() {
    std::vector<std::string> ids;
    for (const MeshPtr& mesh : store_->list()) ids.push_back(mesh->id());
    return ids;
  }

  /// Puts a file in place as the writer does: by rename.
  void replace(const std::string& name, const Bytes& bytes) {
    directory_.write("incoming", bytes);
    fs::rename(directory_ / "incoming", directory_ / name);
  }

  TemporaryDirectory directory_;
  std::unique_ptr<MeshStore> store_;
  const SampleFile first_ = make_sample({100, 200}, 1);
  const SampleFile second_ = make_sample({100, 200}, 2);
};

TEST_F(MeshStoreTest, ListsFilesOfSubdirectoriesById) {
  fs::create_directories(directory_ / "scans/new");
  directory_.write("scans/new/b.pmesh", first_.bytes);
  directory_.write("a.pmesh", second_.bytes);
  open();
  EXPECT_EQ(listed(), (std::vector<std::string>{"a", "scans~new~b"}));
  EXPECT_EQ(store_->find("scans~new~b")->hash(), first_.index.header.content_hash);
}

TEST_F(MeshStoreTest, SkipsWhatIsNoCompletePmFile) {
  Bytes partial = first_.bytes, longer = first_.bytes, altered = first_.bytes;
  partial.pop_back();
  longer.push_back(0);
  altered[kContentHashOffset] ^= 1;
  directory_.write("partial.pmesh", partial);
  directory_.write("longer.pmesh", longer);
  directory_.write("altered.pmesh", altered);
  directory_.write("empty.pmesh", Bytes());
  directory_.write("text.pmesh", as_bytes("not a mesh"));
  directory_.write("mesh.ply", first_.bytes);
  directory_.write("catalog.pmesh", first_.bytes);
  directory_.write("good.pmesh", first_.bytes);
  fs::create_directory(directory_ / "directory.pmesh");
  open();
  EXPECT_EQ(listed(), std::vector<std::string>{"good"});
  EXPECT_EQ(store_->find("partial"), nullptr);
  EXPECT_EQ(store_->find("directory"), nullptr);
}

TEST_F(MeshStoreTest, FindsNothingOutsideTheDirectory) {
  const TemporaryDirectory outside;
  outside.write("secret.pmesh", first_.bytes);
  fs::create_symlink(outside / "secret.pmesh", directory_ / "link.pmesh");
  fs::create_directory_symlink(outside / "", directory_ / "linked");
  open();
  EXPECT_EQ(store_->find("link"), nullptr);
  EXPECT_EQ(store_->find("linked~secret"), nullptr);
  EXPECT_EQ(store_->find("../secret"), nullptr);
  EXPECT_TRUE(listed().empty());
}

TEST_F(MeshStoreTest, FindsAFileThatCameLater) {
  open();
  EXPECT_EQ(store_->find("late"), nullptr);
  replace("late.pmesh", first_.bytes);
  EXPECT_NE(store_->find("late"), nullptr);
  EXPECT_EQ(listed(), std::vector<std::string>{"late"});
}

TEST_F(MeshStoreTest, ForgetsAFileThatWasRemoved) {
  directory_.write("a.pmesh", first_.bytes);
  open();
  fs::remove(directory_ / "a.pmesh");
  EXPECT_TRUE(listed().empty());
  EXPECT_EQ(store_->find("a"), nullptr);
}

TEST_F(MeshStoreTest, GivesTheNewFileAndKeepsTheOldWhileItIsHeld) {
  directory_.write("a.pmesh", first_.bytes);
  open();
  MeshPtr held = store_->find("a");
  replace("a.pmesh", second_.bytes);
  EXPECT_EQ(store_->find("a")->hash(), second_.index.header.content_hash);
  EXPECT_EQ(store_->find("a", held->hash()), held);
  EXPECT_TRUE(held->intact());

  const ContentHash old = held->hash();
  held.reset();
  EXPECT_EQ(store_->find("a", old), nullptr);
}

TEST_F(MeshStoreTest, TakesAFileThatWasRepaired) {
  directory_.write("a.pmesh", as_bytes("broken"));
  open();
  EXPECT_EQ(store_->find("a"), nullptr);
  directory_.write("a.pmesh", first_.bytes);
  EXPECT_NE(store_->find("a"), nullptr);
}

TEST_F(MeshStoreTest, NoticesAFileWrittenInPlace) {
  directory_.write("a.pmesh", first_.bytes);
  open();
  const MeshPtr mesh = store_->find("a");
  fs::resize_file(directory_ / "a.pmesh", first_.bytes.size() - 1);
  EXPECT_FALSE(mesh->intact());
  EXPECT_EQ(store_->find("a"), nullptr);
}

TEST_F(MeshStoreTest, OpensNothingButADirectory) {
  EXPECT_FALSE(MeshStore::open(directory_ / "nowhere").ok());
  EXPECT_FALSE(MeshStore::open(directory_.write("file", Bytes())).ok());
}

}  // namespace
}  // namespace pmesh
