// Lists of pairs of files, as CSV.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace cellocut::tools {

struct FilePair {
  std::size_t line = 0;  // of the list, from 1
  std::string mesh;      // as the list has them
  std::string reference;
  std::string mesh_path;  // seen from where the program runs
  std::string reference_path;
};

// Rows `mesh,reference`; a relative path is relative to the folder of the list. Empty lines, lines
// that begin with '#', and a first row that reads `mesh,reference` are left out. Fields may stand
// in quotes (RFC 4180; "" is a quote), but not go on over the end of a line. "-" names no file
// here. Errors: InputError with the path and the line; where there are no pairs, too.
std::vector<FilePair> read_pairs(const std::string& path);

}  // namespace cellocut::tools
