// An output file that appears whole or not at all: it is written to a temporary file in the target's
// folder and renamed over the target by commit(). Without commit() (an exception, an early return) the
// temporary file is removed and whatever stood at the target stays.
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
  [[noreturn]] void fail(const char* what, int error);

  std::string path_;
  std::string temporary_;
  int descriptor_ = -1;
  int slot_ = -1;
  std::vector<char> buffer_;
};

}  // namespace cellocut
