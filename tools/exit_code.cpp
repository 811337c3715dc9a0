#include "tools/exit_code.h"

#include <fmt/core.h>

#include <cstdio>
#include <new>
#include <system_error>

#include "cellocut/base/errors.h"

namespace cellocut::tools {

void print_error(const std::string& what) { fmt::print(stderr, "cellocut: {}\n", what); }

ErrorLine describe_error(const std::exception& error, const std::string& input) {
  const auto line = [](ExitCode code, const std::string& file, const char* what) {
    return ErrorLine{code, file.empty() ? what : file + ": " + what};
  };
  if (const auto* bad_input = dynamic_cast<const InputError*>(&error)) {
    return line(kBadInput, bad_input->file().empty() ? input : bad_input->file(), error.what());
  }
  if (const auto* output = dynamic_cast<const OutputError*>(&error)) {
    return line(kLimit, output->file(), error.what());
  }
  if (dynamic_cast<const UsageError*>(&error) != nullptr) return line(kUsage, {}, error.what());
  if (dynamic_cast<const LimitError*>(&error) != nullptr) return line(kLimit, input, error.what());
  if (dynamic_cast<const CertificateError*>(&error) != nullptr) {
    return line(kCertificateFailed, input, error.what());
  }
  if (dynamic_cast<const Cancelled*>(&error) != nullptr) {
    return line(kInterrupted, input, error.what());
  }
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
    return line(kLimit, input, "out of memory; try a lower --resolution");
  }
  // A thread that cannot be started, or standard output that is full.
  if (dynamic_cast<const std::system_error*>(&error) != nullptr) {
    return line(kLimit, {}, error.what());
  }
  return line(kNoGuarantee, input, error.what());
}

int report_error(const std::exception& error, const std::string& input) {
  const ErrorLine line = describe_error(error, input);
  print_error(line.text);
  return line.code;
}

}  // namespace cellocut::tools
