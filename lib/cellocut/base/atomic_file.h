// An output file that appears whole or not at all: it is written to a temporary file in the
// target's folder and renamed over the target by commit(). Without commit() (an exception, an early
// return) the temporary file is removed and whatever stood at the target stays. A symbolic link is
// written through; the mode of an existing target is kept. What is no regular file (a device, a
// pipe, /dev/stdout) is written directly.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace cellocut {

class AtomicFile {
 public:
  // Creates the temporary file. `path` "-" is standard output, which is written as it comes.
  // Errors: OutputError that says why (no such folder, no permission, is a directory).
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // Buffered. Errors: OutputError (no room on the disk, file size limit) with the system's words.
  void write(const void* data, std::size_t size);
  void write(std::string_view text) { write(text.data(), text.size()); }

  // Flushes, closes and renames. After it nothing may be written. Errors: OutputError.
  void commit();

  // Removes the temporary files of all AtomicFiles that exist; only for a handler of a fatal signal
  // (async-signal-safe: it calls nothing but unlink on names stored beforehand).
  static void remove_all_temporaries() noexcept;

 private:
  void flush();
  void write_all(const char* data, std::size_t size);
  void create_temporary();
  void discard() noexcept;
  [[noreturn]] void fail(const std::string& what, int error);

  std::string path_;       // as the caller gave it
  std::string target_;     // what it stands for, behind symbolic links
  std::string temporary_;  // empty where the output is written as it comes (a pipe, a device)
  int descriptor_ = -1;
  int slot_ = -1;
  std::vector<char> buffer_;
};

}  // namespace cellocut
