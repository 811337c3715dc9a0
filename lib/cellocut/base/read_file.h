// Reading a whole file.
#pragma once

#include <string>

namespace cellocut {

// All bytes of a file, or of standard input for "-". Plain reads: a mapped file that another
// program shortens would end the process with SIGBUS. Errors: InputError with the path (not there,
// a directory, empty, cannot be read).
std::string read_file(const std::string& path);

}  // namespace cellocut
