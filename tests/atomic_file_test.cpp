// SPDX-License-Identifier: Apache-2.0
// Files that are complete or absent, and leftovers of killed processes.
#include "base/file.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "base/error.h"
#include "run_command.h"

namespace chromeball::atomic_file_test {
namespace {

using Names = std::vector<std::string>;

void write(const AtomicFile& file, const std::string& text) {
  std::ofstream(file.temporary()) << text;
}

TEST(AtomicFile, AppearsWhenComplete) {
  const TemporaryFolder folder;
  const std::string path = folder / "a";
  {
    AtomicFile file(path);
    write(file, "text");
    EXPECT_FALSE(std::filesystem::exists(path));
    file.commit();
  }
  EXPECT_EQ(fileContents(path), "text");
  { write(AtomicFile(path), "other"); }
  EXPECT_EQ(fileContents(path), "text");
  EXPECT_EQ(folder.files(), Names{"a"});
}

TEST(AtomicFile, TakesWhatAKilledProcessLeft) {
  const TemporaryFolder folder;
  const std::string path = folder / "a";
  for (int i = 0; i < 3; ++i) {
    const pid_t child = fork();
    if (child == 0) {
      const AtomicFile file(path);
      write(file, "a long text of which only a half is there");
      raise(SIGKILL);
    }
    waitpid(child, nullptr, 0);
    EXPECT_EQ(folder.files().size(), 1u);  // and no more for each kill
  }
  AtomicFile file(path);
  EXPECT_EQ(fileContents(file.temporary()), "");
  write(file, "text");
  file.commit();
  EXPECT_EQ(fileContents(path), "text");
  EXPECT_EQ(folder.files(), Names{"a"});
}

// Two writers of one file do not mix; the last one wins.
TEST(AtomicFile, IsOfOneWriter) {
  const TemporaryFolder folder;
  const std::string path = folder / "a";
  AtomicFile first(path);
  write(first, "first");
  {
    AtomicFile second(path);
    EXPECT_NE(first.temporary(), second.temporary());
    write(second, "second");
    second.commit();
    EXPECT_EQ(fileContents(path), "second");
  }
  EXPECT_EQ(fileContents(first.temporary()), "first");
  first.commit();
  EXPECT_EQ(fileContents(path), "first");
  EXPECT_EQ(folder.files(), Names{"a"});
}

// Each has a temporary file of its own, also of another process.
TEST(AtomicFile, OfLongNames) {
  const TemporaryFolder folder;
  const std::string begin(253, 'a');
  for (const char* end : {"", "b", "bb", "bc"}) {
    const std::string path = folder / (begin + end);
    AtomicFile file(path);
    write(file, end);
    AtomicFile other(folder / (begin + "xx")), second(path);
    EXPECT_NE(other.temporary(), file.temporary());
    EXPECT_NE(second.temporary(), file.temporary());
    write(second, "second");
    second.commit();
    file.commit();
    EXPECT_EQ(fileContents(path), end);
  }
  EXPECT_EQ(folder.files().size(), 4u);
}

// The system would take such a name for the part before it.
TEST(FileNames, WithNulAreRefused) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a") << "text";
  const std::string path = (folder / "a") + std::string("\0.exr", 5);
  EXPECT_THROW(checkReadable(path), InputError);
  EXPECT_THROW(readFile(path), InputError);
  EXPECT_THROW(checkReplaceable(path), InputError);
  EXPECT_NO_THROW(checkReplaceable(folder / "a"));
}

// Whether a process of another machine still exists is not known.
TEST(AtomicFile, LeavesTheFilesOfOtherMachines) {
  const TemporaryFolder folder;
  const Names others{".a.00000000.17.part", ".a.00000000.part", ".b.00000000.part"};
  for (const std::string& name : others) std::ofstream(folder / name) << "half";
  AtomicFile file(folder / "a");
  write(file, "text");
  file.commit();
  for (const std::string& name : others) EXPECT_EQ(fileContents(folder / name), "half");
}

}  // namespace
}  // namespace chromeball::atomic_file_test
