// A folder of its own for a test, removed with all it holds; and whole files as strings.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace cellocut::test {

class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] std::string path(const std::string& name) const { return (root_ / name).string(); }
  // Writes a file of that name and returns its path.
  [[nodiscard]] std::string file(const std::string& name, std::string_view content) const;
  // Number of entries, hidden ones included: whether something was left behind.
  [[nodiscard]] std::size_t entry_count() const;

 private:
  std::filesystem::path root_;
};

std::string content_of(const std::string& path);

}  // namespace cellocut::test
