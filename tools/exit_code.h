// The exit codes of the program, and the one line that an error gets.
#pragma once

#include <exception>
#include <string>

namespace cellocut::tools {

enum ExitCode : int {
  kDone = 0,
  kUsage = 2,              // wrong usage
  kBadInput = 3,           // unreadable or invalid input
  kNoGuarantee = 4,        // the guarantee could not be met
  kCertificateFailed = 5,  // a certificate failed or exact solvers disagree
  kLimit = 6,              // out of a stated limit: memory, time, integer range, room on a disk
  kInterrupted = 130
};

// What is said of an exception, without the program's name, and its exit code. `input` names the
// file for errors that do not know theirs.
struct ErrorLine {
  ExitCode code;
  std::string text;
};
ErrorLine describe_error(const std::exception& error, const std::string& input);

// Prints `cellocut: [FILE: ]what is wrong` to standard error and says which code goes with the
// exception. `input` names the file for errors that do not know theirs.
int report_error(const std::exception& error, const std::string& input);

// One line on standard error, as above.
void print_error(const std::string& what);

}  // namespace cellocut::tools
