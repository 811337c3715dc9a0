#include "cellocut/base/atomic_file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "cellocut/base/errors.h"
#include "support/temporary_folder.h"

namespace cellocut {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

void write_file(const std::string& path, std::string_view content) {
  AtomicFile file(path);
  file.write(content);
  file.commit();
}

unsigned mode_of(const std::string& path) {
  struct stat status {};
  EXPECT_EQ(::stat(path.c_str(), &status), 0);
  return status.st_mode & 07777;
}

TEST(AtomicFile, AppearsWithCommitOnly) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path("out");
  {
    AtomicFile file(path);
    file.write("new");
    EXPECT_FALSE(std::filesystem::exists(path));
    file.commit();
    EXPECT_EQ(test::content_of(path), "new");
  }
  EXPECT_EQ(folder.entry_count(), 1u);
  { AtomicFile(path).write("never seen"); }
  EXPECT_EQ(test::content_of(path), "new");
  EXPECT_EQ(folder.entry_count(), 1u);
}

TEST(AtomicFile, LargeAndEmptyContent) {
  const test::TemporaryFolder folder;
  std::string content;
  while (content.size() < 5'000'000) content += std::to_string(content.size());
  AtomicFile file(folder.path("large"));
  for (std::size_t at = 0, piece = 1; at < content.size(); at += piece, piece = piece * 3 + 1) {
    file.write(std::string_view(content).substr(at, piece));
  }
  file.commit();
  EXPECT_EQ(test::content_of(folder.path("large")), content);
  write_file(folder.path("empty"), "");
  EXPECT_EQ(test::content_of(folder.path("empty")), "");
}

TEST(AtomicFile, Permissions) {
  const test::TemporaryFolder folder;
  const mode_t mask = ::umask(027);
  write_file(folder.path("new"), "a");
  ::umask(mask);
  EXPECT_EQ(mode_of(folder.path("new")), 0640u);
  const std::string old = folder.file("old", "b");
  ASSERT_EQ(::chmod(old.c_str(), 0604), 0);
  write_file(old, "c");
  EXPECT_EQ(mode_of(old), 0604u);
  EXPECT_EQ(test::content_of(old), "c");
}

TEST(AtomicFile, WritesThroughSymbolicLinks) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder.path("sub"));
  const std::string target = folder.file("sub/target", "old");
  std::filesystem::create_symlink("sub/target", folder.path("link"));
  std::filesystem::create_symlink("link", folder.path("link-to-link"));
  write_file(folder.path("link-to-link"), "new");
  EXPECT_EQ(test::content_of(target), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path("link")));
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path("link-to-link")));

  std::filesystem::create_symlink("sub/later", folder.path("dangling"));
  write_file(folder.path("dangling"), "made");
  EXPECT_EQ(test::content_of(folder.path("sub/later")), "made");

  std::filesystem::create_symlink("loop", folder.path("loop"));
  EXPECT_THAT([&] { AtomicFile file(folder.path("loop")); },
              ThrowsMessage<OutputError>(HasSubstr("symbolic links")));
}

TEST(AtomicFile, WhatIsNoRegularFileIsWrittenDirectly) {
  const test::TemporaryFolder folder;
  write_file("/dev/null", "gone");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));

  const std::string pipe = folder.path("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::string received;
  std::thread reader([&] { received = test::content_of(pipe); });
  write_file(pipe, "through the pipe");
  reader.join();
  EXPECT_EQ(received, "through the pipe");
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
  EXPECT_EQ(folder.entry_count(), 1u);
}

TEST(AtomicFile, ErrorsSayWhy) {
  const test::TemporaryFolder folder;
  const std::string missing = folder.path("none/out");
  try {
    AtomicFile file(missing);
    ADD_FAILURE() << "created";
  } catch (const OutputError& error) {
    EXPECT_EQ(error.file(), missing);
    EXPECT_THAT(error.what(), HasSubstr("No such file or directory"));
  }
  std::filesystem::create_directory(folder.path("folder"));
  for (const char* name : {"folder", "folder/", "new/"}) {
    EXPECT_THAT([&] { AtomicFile file(folder.path(name)); },
                ThrowsMessage<OutputError>(HasSubstr("directory")));
  }
  EXPECT_THROW(AtomicFile(""), OutputError);
  const std::string file = folder.file("file", "x");
  EXPECT_THAT([&] { AtomicFile below(file + "/out"); },
              ThrowsMessage<OutputError>(HasSubstr("Not a directory")));
  EXPECT_THAT(
      [&] {
        AtomicFile full("/dev/full");
        full.write("x");
        full.commit();
      },
      ThrowsMessage<OutputError>(HasSubstr("No space left on device")));
}

TEST(AtomicFile, FileSizeLimitLeavesTheOldFile) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("out", "old content");
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  rlimit limited = before;
  limited.rlim_cur = 5000;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limited), 0);
  EXPECT_THAT([&] { write_file(path, std::string(6000, 'x')); },
              ThrowsMessage<OutputError>(HasSubstr("File too large")));
  EXPECT_THAT([&] { write_file(path, std::string(3'000'000, 'x')); },
              ThrowsMessage<OutputError>(HasSubstr("File too large")));
  EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  EXPECT_EQ(test::content_of(path), "old content");
  EXPECT_EQ(folder.entry_count(), 1u);
}

TEST(AtomicFile, MoreFilesThanThereIsRoomForIsAnError) {
  const test::TemporaryFolder folder;
  std::vector<std::unique_ptr<AtomicFile>> files;
  const auto open_many = [&] {
    for (int i = 0; i < 1000; ++i) {
      files.push_back(std::make_unique<AtomicFile>(folder.path(std::to_string(i))));
    }
  };
  EXPECT_THAT(open_many, ThrowsMessage<OutputError>(HasSubstr("too many output files")));
  EXPECT_GE(files.size(), 60u);
  files.clear();
  EXPECT_EQ(folder.entry_count(), 0u);
  write_file(folder.path("again"), "x");
}

// ---- in a program of its own
// ----------------------------------------------------------------------

struct ProgramRun {
  int exit_code = -1;
  std::string output;
};

// Runs the writer with `environment` (assignments for env(1)) and `arguments`.
ProgramRun run_writer(const std::string& environment, const std::string& arguments) {
  const std::string command =
      "env " + environment + " '" CELLOCUT_ATOMIC_FILE_WRITER "' " + arguments;
  ProgramRun run;
  FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  EXPECT_NE(pipe, nullptr);
  std::array<char, 4096> buffer{};
  while (const std::size_t got = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    run.output.append(buffer.data(), got);
  }
  const int status = ::pclose(pipe);
  run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return run;
}

// A sanitizer's library wants to be first; it may be second here.
const std::string kShortWrite =
    "ASAN_OPTIONS=verify_asan_link_order=0 LD_PRELOAD='" CELLOCUT_SHORT_WRITE "' ";

std::string numbers(std::size_t size) {
  std::string content;
  for (int i = 0; content.size() < size; ++i) content += std::to_string(i) + '\n';
  content.resize(size);
  return content;
}

TEST(AtomicFileOnAFullDisk, LeavesTheOldFile) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("out", "old content");
  for (const char* limit : {"0", "1", "1000", "1048575", "1048576", "2999999"}) {
    const ProgramRun run =
        run_writer(kShortWrite + "CELLOCUT_TEST_WRITE_LIMIT=" + limit, path + " 3000000");
    EXPECT_EQ(run.exit_code, 6);
    EXPECT_THAT(run.output, HasSubstr("No space left on device"));
    EXPECT_THAT(run.output, HasSubstr(path));
    EXPECT_EQ(test::content_of(path), "old content");
    EXPECT_EQ(folder.entry_count(), 1u);
  }
  const ProgramRun enough =
      run_writer(kShortWrite + "CELLOCUT_TEST_WRITE_LIMIT=3000000", path + " 3000000");
  EXPECT_EQ(enough.exit_code, 0) << enough.output;
  EXPECT_EQ(test::content_of(path), numbers(3000000));
}

TEST(AtomicFileOnAFullDisk, ShortWritesAloneLoseNothing) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path("out");
  const ProgramRun run = run_writer(kShortWrite + "CELLOCUT_TEST_WRITE_SHORT=1", path + " 2345678");
  EXPECT_EQ(run.exit_code, 0) << run.output;
  EXPECT_EQ(test::content_of(path), numbers(2345678));
}

TEST(AtomicFileInAProgram, NothingStaysAfterASignalOrWithoutCommit) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("out", "old content");
  EXPECT_EQ(run_writer("", path + " 2000000 killed").exit_code, 130);
  EXPECT_EQ(run_writer("", path + " 2000000 abandon").exit_code, 0);
  EXPECT_EQ(test::content_of(path), "old content");
  EXPECT_EQ(folder.entry_count(), 1u);
}

TEST(AtomicFileInAProgram, StandardOutput) {
  for (const char* name : {"-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"}) {
    const ProgramRun run = run_writer("", std::string(name) + " 200000");
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_EQ(run.output, numbers(200000));
  }
  // Where the shell sent standard output to a file, that file is appended to, not replaced.
  const test::TemporaryFolder folder;
  const std::string path = folder.file("log", "before\n");
  EXPECT_EQ(run_writer("", "/dev/stdout 100 >> '" + path + "'").exit_code, 0);
  EXPECT_EQ(test::content_of(path), "before\n" + numbers(100));
}

}  // namespace
}  // namespace cellocut
