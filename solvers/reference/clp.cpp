// clp: the simplex code of COIN-OR, run as a program on an LP file, as an outside witness.
//
// Definition. An adapter: CutProblem -> the linear program of the maximum flow, one variable per
// edge between minus its reverse and its capacity and one per terminal arc, one balance per node ->
// an LP file in a temporary folder -> the program `clp` -> its binary solution -> net flow per
// edge. Its matrix is totally unimodular, so a simplex method ends at an integral flow: basic
// solutions are sums and differences of capacities, which doubles hold exactly. Values are rounded
// to the nearest integer, and the flow is checked as that of any solver.
//
// Why a program. The library's licence (EPL-2.0) forbids linking it into this program.
//
// Limits. For small problems: it refuses more nodes and edges than kSizeLimit, and capacities that
// sum to 2^50 or more. The program is found in the PATH and may be taken away after the build: that
// is a LimitError which names it.
//
// Complexity. That of the dual simplex method, in practice a little above quadratic here.
//
// Reference. J. Forrest et al.: COIN-OR linear programming solver (Clp), as packaged.
//
// Licence: GPL-3.0-or-later (adapter), EPL-2.0 (program). Capabilities: exact, one thread, can be
// cancelled.
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>

#include "cellocut/base/errors.h"
#include "solvers/residual_graph.h"
#include "solvers/solvers.h"

extern char** environ;  // NOLINT(readability-redundant-declaration): not in every <unistd.h>

namespace cellocut::solvers {

namespace {

constexpr std::size_t kSizeLimit = 100000;  // nodes and edges

// A folder of our own, removed with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "cellocut-clp-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) {
      throw LimitError("clp: cannot make a temporary folder: " + std::string(std::strerror(errno)));
    }
    path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] std::string file(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

// A running program: ended and waited for, whatever happens.
class Process {
 public:
  Process(std::vector<std::string> arguments, const std::string& log) {
    std::vector<char*> pointers;
    pointers.reserve(arguments.size() + 1);
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    const int error =
        posix_spawnp(&process_, pointers[0], &actions, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) {
      process_ = -1;
      throw LimitError("clp: cannot run the program '" + arguments[0] +
                       "' (package coinor-clp): " + std::strerror(error));
    }
  }
  ~Process() {
    if (process_ <= 0) return;
    kill(process_, SIGKILL);
    while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  // Whether it ended well.
  bool wait(const SolveContext& context) {
    std::chrono::milliseconds pause(1);
    while (true) {
      int status = 0;
      const pid_t ended = waitpid(process_, &status, WNOHANG);
      if (ended == process_) {
        process_ = -1;
        return WIFEXITED(status) && WEXITSTATUS(status) == 0;
      }
      if (ended < 0 && errno != EINTR) return false;
      context.check();
      std::this_thread::sleep_for(pause);
      pause = std::min(2 * pause, std::chrono::milliseconds(50));
    }
  }

 private:
  pid_t process_ = -1;
};

// Columns are numbered in the order in which their names first appear, in the objective: the edges,
// then the terminals.
std::size_t write_program(const CutProblem& problem, const ResidualGraph& graph,
                          const std::string& path) {
  std::ofstream file(path, std::ios::binary);
  std::size_t columns = 0;
  file << "Maximize\nvalue:\n";
  for (std::size_t e = 0; e < problem.edges.size(); ++e) {
    if (!has_arcs(problem.edges[e])) continue;
    file << "+ 0 f" << e << "\n";
    ++columns;
  }
  for (std::uint32_t i = 0; i < graph.node_count(); ++i) {
    if (graph.terminal[i] == 0) continue;
    file << (graph.terminal[i] > 0 ? "+ 1 t" : "+ 0 t") << i << "\n";
    ++columns;
  }
  file << "Subject To\n";
  for (std::uint32_t i = 0; i < graph.node_count(); ++i) {
    if (graph.row[i] == graph.row[i + 1] && graph.terminal[i] == 0) continue;
    file << "b" << i << ":\n";
    for (std::uint32_t a = graph.row[i]; a < graph.row[i + 1]; ++a) {
      const std::uint32_t id = graph.arcs[a].id;
      file << ((id & 1U) == 0 ? "+ f" : "- f") << id / 2 << "\n";
    }
    if (graph.terminal[i] != 0) file << (graph.terminal[i] > 0 ? "- t" : "+ t") << i << "\n";
    file << "= 0\n";
  }
  file << "Bounds\n";
  for (std::size_t e = 0; e < problem.edges.size(); ++e) {
    const CutEdge& edge = problem.edges[e];
    if (!has_arcs(edge)) continue;
    file << -edge.reverse_capacity << " <= f" << e << " <= " << edge.capacity << "\n";
  }
  for (std::uint32_t i = 0; i < graph.node_count(); ++i) {
    if (graph.terminal[i] == 0) continue;
    file << "0 <= t" << i << " <= " << std::abs(graph.terminal[i]) << "\n";
  }
  file << "End\n";
  file.close();
  if (!file) throw LimitError("clp: cannot write '" + path + "'");
  return columns;
}

// The program's binary solution: two counts, the objective, and for rows and then for columns the
// values and the duals. Text would have eight digits.
std::vector<double> read_columns(const std::string& path, std::size_t columns) {
  std::ifstream file(path, std::ios::binary);
  std::array<std::int32_t, 2> counts{};
  file.read(reinterpret_cast<char*>(counts.data()), sizeof(counts));
  std::vector<double> values(columns);
  if (file && counts[0] >= 0 && counts[1] >= 0 && static_cast<std::size_t>(counts[1]) == columns) {
    file.ignore(static_cast<std::streamsize>(sizeof(double)) * (1 + 2 * std::int64_t{counts[0]}));
    file.read(reinterpret_cast<char*>(values.data()),
              static_cast<std::streamsize>(columns * sizeof(double)));
    if (file) return values;
  }
  throw LimitError("clp: the program left no solution");
}

class Clp final : public CutSolver {
 public:
  [[nodiscard]] const SolverInfo& info() const override {
    static const SolverInfo info = [] {
      SolverInfo i;
      i.name = "clp";
      i.summary = "COIN-OR's simplex program on the flow's linear program, small problems only";
      i.licence = "GPL-3.0-or-later; runs a program under EPL-2.0";
      i.reference = "Forrest et al., COIN-OR Clp";
      i.outside = true;
      i.capacity_limit = std::int64_t{1} << 50;
      return i;
    }();
    return info;
  }

 private:
  SolverOutput do_solve(const CutProblem& problem, SolveContext& context) override {
    context.check();
    if (problem.node_count() + problem.edges.size() > kSizeLimit) {
      throw LimitError("clp: " + std::to_string(problem.node_count()) + " nodes and " +
                       std::to_string(problem.edges.size()) +
                       " edges; this reference takes small problems only, up to " +
                       std::to_string(kSizeLimit) + " of both together");
    }
    const ResidualGraph graph(problem);
    const TemporaryFolder folder;
    const std::string solution = folder.file("solution.bin");
    const std::size_t columns = write_program(problem, graph, folder.file("flow.lp"));
    context.built();
    SolverOutput output;
    output.edge_flow.assign(problem.edges.size(), 0);
    output.bytes = graph.bytes();
    if (columns > 0) {
      // No scaling, no perturbation, no presolve: numbers stay sums of capacities.
      Process process({"clp", folder.file("flow.lp"), "-presolve", "off", "-scaling", "off",
                       "-perturbation", "off", "-dualsimplex", "-saveSolution", solution},
                      folder.file("log"));
      if (!process.wait(context)) throw LimitError("clp: the program failed");
      const std::vector<double> values = read_columns(solution, columns);
      std::size_t column = 0;
      for (std::size_t e = 0; e < problem.edges.size(); ++e) {
        if (has_arcs(problem.edges[e])) output.edge_flow[e] = std::llround(values[column++]);
      }
    }
    context.check();
    return output;
  }
};

}  // namespace

std::unique_ptr<CutSolver> make_clp();
std::unique_ptr<CutSolver> make_clp() { return std::make_unique<Clp>(); }

}  // namespace cellocut::solvers
