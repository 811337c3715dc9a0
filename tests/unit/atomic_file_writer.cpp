// A program for atomic_file_test: writes a file through AtomicFile as any output is written.
//   atomic_file_writer PATH BYTES [abandon|killed]
// The content is the numbers from 0, one a line, cut off after BYTES. Exit 6 with the reason on
// standard error where it cannot be written.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "cellocut/base/atomic_file.h"
#include "cellocut/base/errors.h"

int main(int argument_count, char** arguments) {
  if (argument_count < 3) return 2;
  const std::string mode = argument_count > 3 ? arguments[3] : "commit";
  std::string content;
  const std::size_t size = std::strtoull(arguments[2], nullptr, 10);
  for (int i = 0; content.size() < size; ++i) content += std::to_string(i) + '\n';
  content.resize(size);
  try {
    cellocut::AtomicFile file(arguments[1]);
    // In pieces of several sizes, to and fro across the buffer's end.
    for (std::size_t at = 0, piece = 1; at < size; at += piece, piece = (piece * 7) % 99991) {
      file.write(content.substr(at, piece));
    }
    if (mode == "abandon") return 0;
    if (mode == "killed") {
      std::signal(SIGTERM, [](int) {
        cellocut::AtomicFile::remove_all_temporaries();
        std::_Exit(130);
      });
      std::raise(SIGTERM);
    }
    file.commit();
  } catch (const cellocut::OutputError& error) {
    std::fprintf(stderr, "%s: %s\n", error.file().c_str(), error.what());
    return 6;
  }
  return 0;
}
