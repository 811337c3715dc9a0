// The `cellocut` program: picks the subcommand, runs it, turns exceptions into exit codes.
#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <limits>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "cellocut_version.h"
#include "tools/commands.h"
#include "tools/exit_code.h"
#include "tools/session.h"

namespace cellocut::tools {
namespace {

// Whether what was printed has not arrived; not so where its reader has gone away.
bool is_output_lost() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return false;
  pollfd reader{STDOUT_FILENO, POLLOUT, 0};
  return poll(&reader, 1, 0) < 1 || (reader.revents & POLLERR) == 0;
}

int run_program(int argc, char** argv) {
  CLI::App program{
      "Turns a defective triangle mesh into a closed, manifold, embedded solid by a minimum cut "
      "over "
      "the cells of a Delaunay tetrahedralization."};
  program.name("cellocut");
  program.set_version_flag("--version", kCellocutVersion);
  program.require_subcommand(1);
  std::vector<Command> commands{add_remesh(program), add_compare(program),  add_solve(program),
                                add_check(program),  add_evaluate(program), add_scan(program),
                                add_damage(program), add_render(program),   add_list(program),
                                add_bench(program),  add_path(program)};
#ifdef CELLOCUT_WITH_VIZ
  commands.push_back(add_section(program));
#endif
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return program.exit(error);  // --help, --version
    if (program.get_subcommands().empty() && argc > 1) {
      print_error("'" + std::string(argv[1]) + "' is no command (see cellocut --help)");
      return kUsage;
    }
    print_error(std::string(error.what()) + " (see cellocut --help)");
    return kUsage;
  }
  install_signal_handlers();
  for (const Command& command : commands) {
    if (!command.app->parsed()) continue;
    try {
      const int code = command.run();
      if (code != kDone || !is_output_lost()) return code;
      print_error("standard output: cannot be written");
      return kLimit;
    } catch (const std::exception& error) {
      return report_error(error, command.input ? command.input() : std::string());
    }
  }
  return kUsage;
}

}  // namespace
}  // namespace cellocut::tools

int main(int argc, char** argv) {
#ifdef __GLIBC__
  // Stages free arrays of many megabytes and ask for others at once: kept, their pages need not be
  // made and cleared anew each time, which takes as long as some stages.
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
#endif
  try {
    return cellocut::tools::run_program(argc, argv);
  } catch (...) {
    // Not even the message of an error could be put together.
    std::fputs("cellocut: out of memory\n", stderr);
    return cellocut::tools::kLimit;
  }
}
