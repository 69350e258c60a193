#include "core/pm/pm_file.h"

#include <gtest/gtest.h>

#include "tests/fixtures/pm_files.h"
#include "tests/fixtures/shapes.h"
#include "tests/fixtures/temporary_directory.h"

namespace pmesh {
namespace {

class PmFileTest : public ::testing::Test {
 protected:
  std::string write_prefix(std::size_t bytes) {
    return directory_.write("part.pmesh", ByteView(shape_.file).first(bytes));
  }
  std::string error_of_prefix(std::size_t bytes) {
    const auto opened = PmFile::open(write_prefix(bytes));
    return opened ? "none" : opened.error().message;
  }

  TemporaryDirectory directory_;
  EncodedShape shape_ = encode_shape("ball", shapes::icosphere(4));
  FileIndex index_ = **parse_prologue(shape_.file);
};

TEST_F(PmFileTest, DecodesAnyNumberOfChunks) {
  const auto file = PmFile::open(write_prefix(shape_.file.size()));
  ASSERT_TRUE(file.ok());
  EXPECT_TRUE(file->complete());
  for (std::size_t chunks = 0; chunks <= index_.chunks.size(); ++chunks) {
    const auto mesh = file->decode(chunks);
    ASSERT_TRUE(mesh.ok());
    EXPECT_EQ(mesh->face_count(), index_.faces_after(chunks));
  }
}

TEST_F(PmFileTest, TakesAPartialFileUpToItsLastWholeChunk) {
  for (std::size_t bytes = index_.base_end(); bytes < shape_.file.size(); bytes += 97) {
    const auto file = PmFile::open(write_prefix(bytes));
    ASSERT_TRUE(file.ok()) << file.error().message;
    EXPECT_FALSE(file->complete());
    EXPECT_LE(index_.prefix_bytes(file->whole_chunks()), bytes);
    EXPECT_GT(index_.prefix_bytes(file->whole_chunks() + 1), bytes);
    EXPECT_TRUE(file->decode(file->whole_chunks()).ok());
  }
}

TEST_F(PmFileTest, SaysWhatIsMissingBelowTheBase) {
  const std::string path = directory_ / "part.pmesh";
  EXPECT_EQ(error_of_prefix(0), path + ": the file ends inside header and index");
  EXPECT_EQ(error_of_prefix(30), path + ": the file ends inside header and index");
  EXPECT_EQ(error_of_prefix(index_.base_end() - 5),
            path + ": the file ends inside the base mesh: 5 bytes are missing");
}

TEST_F(PmFileTest, RefusesAFileThatIsTooLongOrHasAWrongHash) {
  Bytes longer = shape_.file;
  longer.push_back(1);
  const std::string path = directory_.write("long.pmesh", longer);
  EXPECT_EQ(PmFile::open(path).error().message, path + ": the file is 1 bytes too long");
  Bytes forged = shape_.file;
  forged[kContentHashOffset] ^= 1;
  const std::string forged_path = directory_.write("forged.pmesh", forged);
  EXPECT_EQ(PmFile::open(forged_path).error().message,
            forged_path + ": header and index: wrong content hash");
}

TEST_F(PmFileTest, NamesAFileThatIsNotThere) {
  const auto file = PmFile::open(directory_ / "none.pmesh");
  ASSERT_FALSE(file.ok());
  EXPECT_EQ(file.error().code, ErrorCode::runtime);
}

}  // namespace
}  // namespace pmesh
