#include "tools/pair_list.h"

#include <filesystem>
#include <string_view>

#include "cellocut/base/errors.h"
#include "cellocut/base/read_file.h"
#include "cellocut/base/text.h"

namespace cellocut::tools {

namespace {

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

// Takes a field in quotes, up to and with its last quote, off the front of `rest`.
std::string take_quoted(std::string_view& rest, std::size_t line) {
  std::string field;
  for (std::size_t i = 1; i < rest.size(); ++i) {
    if (rest[i] != '"') {
      field += rest[i];
    } else if (i + 1 < rest.size() && rest[i + 1] == '"') {
      field += rest[++i];
    } else {
      rest.remove_prefix(i + 1);
      return field;
    }
  }
  fail_at_line(line, "a quote is not closed");
}

std::vector<std::string> fields_of(std::string_view row, std::size_t line) {
  std::vector<std::string> fields;
  for (std::string_view rest = row;;) {
    rest = trimmed(rest);
    if (!rest.empty() && rest.front() == '"') {
      fields.push_back(take_quoted(rest, line));
      rest = trimmed(rest);
      if (!rest.empty() && rest.front() != ',') {
        fail_at_line(line, "something follows a closed quote");
      }
    } else {
      const std::string_view field = rest.substr(0, rest.find(','));
      fields.emplace_back(trimmed(field));
      rest.remove_prefix(field.size());
    }
    if (rest.empty()) return fields;
    rest.remove_prefix(1);
  }
}

std::vector<FilePair> parse(std::string_view text, const std::filesystem::path& folder) {
  std::vector<FilePair> pairs;
  bool first = true;
  std::size_t line = 0;
  while (!text.empty()) {
    const std::string_view whole = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), whole.size() + 1));
    ++line;
    const std::string_view row = trimmed(whole);
    if (row.empty() || row.front() == '#') continue;
    std::vector<std::string> fields = fields_of(row, line);
    const bool heads = first && fields == std::vector<std::string>{"mesh", "reference"};
    first = false;
    if (heads) continue;
    if (fields.size() != 2) {
      fail_at_line(line, "a row is `mesh,reference`, this one has " +
                             std::to_string(fields.size()) + " fields");
    }
    for (const std::string& field : fields) {
      if (field.empty()) fail_at_line(line, "a name is empty");
      if (field == "-") fail_at_line(line, "'-' is no file");
    }
    pairs.push_back({.line = line,
                     .mesh = fields[0],
                     .reference = fields[1],
                     .mesh_path = (folder / fields[0]).string(),
                     .reference_path = (folder / fields[1]).string()});
  }
  if (pairs.empty()) throw InputError("no pairs");
  return pairs;
}

}  // namespace

std::vector<FilePair> read_pairs(const std::string& path) {
  try {
    return parse(read_file(path), std::filesystem::path(path).parent_path());
  } catch (const InputError& error) {
    throw InputError(error.what(), path);
  }
}

}  // namespace cellocut::tools
