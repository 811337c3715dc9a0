// The subcommands. Each adds itself to the program and returns what runs it: the exit code, or an
// exception that report_error() turns into one.
#pragma once

#include <functional>
#include <string>

namespace CLI {
class App;
}

namespace cellocut::tools {

struct Command {
  CLI::App* app = nullptr;
  std::function<int()> run;
  std::function<std::string()> input;  // the input's name, for errors
};

Command add_remesh(CLI::App& program);
Command add_check(CLI::App& program);
Command add_list(CLI::App& program);
Command add_section(CLI::App& program);
Command add_solve(CLI::App& program);
Command add_compare(CLI::App& program);
Command add_evaluate(CLI::App& program);
Command add_bench(CLI::App& program);
Command add_scan(CLI::App& program);
Command add_damage(CLI::App& program);
Command add_render(CLI::App& program);
Command add_path(CLI::App& program);

}  // namespace cellocut::tools
