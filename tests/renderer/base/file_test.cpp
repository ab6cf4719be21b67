#include "renderer/base/file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "renderer/base/error.h"

namespace parian {
namespace {

class FileTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) / fmt::format("parian_file_{}", test->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string content(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  int entries() const {
    return int(
        std::distance(std::filesystem::directory_iterator(folder_), std::filesystem::directory_iterator()));
  }

 private:
  std::filesystem::path folder_;
};

template <class Action>
std::string message_of(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no InputError";
}

TEST_F(FileTest, ReadsBackWhatItWrote) {
  const std::string bytes("a\0b\r\n\xff", 6);
  write_file(path("x.bin"), bytes);
  const std::vector<char> read = read_file(path("x.bin"));
  EXPECT_EQ(std::string(read.begin(), read.end()), bytes);
  write_file(path("empty"), "");
  EXPECT_TRUE(read_file(path("empty")).empty());
  EXPECT_EQ(entries(), 2) << "no temporary file is left";
}

TEST_F(FileTest, NamesAFileThatCannotBeRead) {
  EXPECT_NE(message_of([&] { read_file(path("missing")); }).find(path("missing")), std::string::npos);
  EXPECT_NE(message_of([&] { read_file(path("")); }).find("folder"), std::string::npos);
}

// Catches writing in place: a reader of the old file goes on reading it.
TEST_F(FileTest, AFileAppearsWholeOrNotAtAll) {
  write_file(path("x.exr"), "old");
  std::ifstream reader(path("x.exr"));
  write_file(path("x.exr"), "new");
  std::string read;
  reader >> read;
  EXPECT_EQ(read, "old");
  EXPECT_EQ(content("x.exr"), "new");
  EXPECT_EQ(entries(), 1) << "no temporary file is left";
}

TEST_F(FileTest, NamesAFileThatCannotBeWritten) {
  const std::string nowhere = path("no_such_folder/x");
  EXPECT_NE(message_of([&] { write_file(nowhere, "x"); }).find(nowhere), std::string::npos);
  std::filesystem::create_directories(path("folder/inside"));
  EXPECT_NE(message_of([&] { write_file(path("folder"), "x"); }).find(path("folder")), std::string::npos);
  EXPECT_EQ(entries(), 1) << "the folder alone";
  EXPECT_THROW(write_file("/dev/null", "x"), InputError) << "a rename would replace the device";
}

TEST(InputError, IsOneLineOfFilePlaceAndExpectation) {
  EXPECT_STREQ(InputError("a.gltf", "/nodes/3", "expected a number").what(),
               "a.gltf: /nodes/3: expected a number");
  EXPECT_STREQ(InputError("a.gltf", "", "expected a number").what(), "a.gltf: expected a number");
}

}  // namespace
}  // namespace parian
