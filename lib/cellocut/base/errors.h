// Everything that CelloCut throws. An outcome (a gap left, a certificate that failed) is a status
// in a result; a caller's mistake, a bad file or a limit that was hit is one of these exceptions.
#pragma once

#include <stdexcept>
#include <string>

namespace cellocut {

// The root: catch this to catch all of them.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// An option or an argument makes no sense (the program exits with 2).
class UsageError : public Error {
 public:
  using Error::Error;
};

// A file cannot be read, or what it holds is not a valid input (exit 3).
// `file` is the path as the user gave it, empty for data that came from memory.
class InputError : public Error {
 public:
  explicit InputError(const std::string& what, std::string file = {})
      : Error(what), file_(std::move(file)) {}
  [[nodiscard]] const std::string& file() const { return file_; }

 private:
  std::string file_;
};

// The promised result cannot be given: an empty solid, a surface that fails its check (exit 4).
class GuaranteeError : public Error {
 public:
  using Error::Error;
};

// A solver claims what its result does not prove (exit 5).
class CertificateError : public Error {
 public:
  using Error::Error;
};

// A stated limit was reached: memory, time, integer range, room on a disk (exit 6).
class LimitError : public Error {
 public:
  using Error::Error;
};

// An output cannot be written: no such folder, no permission, no room (exit 6).
class OutputError : public LimitError {
 public:
  OutputError(const std::string& what, std::string file)
      : LimitError(what), file_(std::move(file)) {}
  [[nodiscard]] const std::string& file() const { return file_; }

 private:
  std::string file_;
};

// The observer asked to stop (exit 130).
class Cancelled : public Error {
 public:
  Cancelled() : Error("interrupted") {}
};

}  // namespace cellocut
