// cellocut bench: a suite of meshes and methods, run by Snakemake; this is only its front.
#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>

#include "cellocut/base/errors.h"
#include "tools/commands.h"
#include "tools/exit_code.h"
#include "tools/session.h"

namespace cellocut::tools {

namespace {

namespace fs = std::filesystem;

struct BenchArguments {
  CommonOptions common;
  std::string suite;
  std::string output;
  std::string workflow;
  std::string datasets;
  std::string profile;
  std::vector<std::string> engine;
  bool dry_run = false;
};

fs::path own_folder() { return fs::read_symlink("/proc/self/exe").parent_path(); }

// The folder of the Snakefile: beside an installed program, or in the clone that the program or the
// working folder is in.
fs::path find_workflow(const std::string& named) {
  if (!named.empty()) {
    if (fs::is_regular_file(fs::path(named) / "Snakefile")) return fs::absolute(named);
    throw UsageError(named + ": holds no Snakefile");
  }
  fs::path installed = own_folder().parent_path() / "share" / "cellocut" / "bench";
  if (fs::is_regular_file(installed / "Snakefile")) return installed;
  for (const fs::path& start : {own_folder(), fs::current_path()}) {
    for (fs::path folder = start; folder != folder.root_path(); folder = folder.parent_path()) {
      if (fs::is_regular_file(folder / "tools" / "bench" / "Snakefile")) {
        return folder / "tools" / "bench";
      }
    }
  }
  throw UsageError("the workflow is not found beside the program; name its folder by --workflow");
}

// Where results and data sets go by default: the clone's build folder, or that of the working
// folder.
fs::path build_folder(const fs::path& workflow) {
  const fs::path clone = workflow.parent_path().parent_path();
  return (fs::is_regular_file(clone / "CMakeLists.txt") ? clone : fs::current_path()) / "build";
}

// A suite's file by its path, or by its name among those of the workflow.
fs::path find_suite(const std::string& name, const fs::path& workflow) {
  if (fs::is_regular_file(name)) return fs::absolute(name);
  fs::path ours = workflow / "suites" / (name + ".yaml");
  if (fs::is_regular_file(ours)) return ours;
  std::string names;
  for (const auto& entry : fs::directory_iterator(workflow / "suites")) {
    if (entry.path().extension() == ".yaml") names += " " + entry.path().stem().string();
  }
  throw UsageError("no suite '" + name + "'; give a file, or one of:" + names);
}

void require_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::string folders = path != nullptr ? path : "";
  folders += ':';
  for (std::size_t at = 0, end = 0; (end = folders.find(':', at)) != std::string::npos;
       at = end + 1) {
    const std::string file = folders.substr(at, end - at) + "/" + name;
    if (access(file.c_str(), X_OK) == 0) return;
  }
  throw UsageError("bench needs the program " + name +
                   ", which is not installed: tools/setup bench, or apt-get install snakemake "
                   "python3-matplotlib");
}

std::vector<std::string> engine_command(const BenchArguments& a, const fs::path& workflow,
                                        const fs::path& suite, const fs::path& output) {
  const fs::path datasets =
      a.datasets.empty() ? build_folder(workflow) / "datasets" : fs::absolute(a.datasets);
  std::vector<std::string> command{"snakemake", "--snakefile", (workflow / "Snakefile").string(),
                                   "--directory", output.string()};
  if (a.profile.empty()) {
    command.insert(command.end(),
                   {"--cores", a.common.threads > 0 ? std::to_string(a.common.threads) : "all"});
  } else {
    const fs::path ours = workflow / "profiles" / a.profile;
    command.insert(
        command.end(),
        {"--profile", fs::is_directory(ours) ? ours.string() : fs::absolute(a.profile).string()});
  }
  // A changed command or limit runs again; the file times of the suite do not matter. The engine's
  // own lock would outlive a kill: lock_folder() holds one that does not.
  command.insert(command.end(), {"--rerun-incomplete", "--keep-going", "--nolock",
                                 "--rerun-triggers", "mtime", "params"});
  if (a.dry_run) command.emplace_back("--dry-run");
  if (!a.common.verbose) {
    command.insert(command.end(), {"--quiet", a.common.quiet ? "all" : "rules"});
  }
  command.insert(command.end(), a.engine.begin(), a.engine.end());
  command.insert(command.end(), {"--config", "suite=" + suite.string(),
                                 "bin=" + own_folder().string(), "datasets=" + datasets.string()});
  return command;
}

// One run at a time in a folder. The lock ends with the process, however that ends.
int lock_folder(const fs::path& folder) {
  const fs::path path = folder / ".bench-lock";
  const int file = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (file < 0) throw OutputError(std::strerror(errno), path.string());
  if (flock(file, LOCK_EX | LOCK_NB) != 0) {
    close(file);
    throw UsageError(folder.string() + ": another run is at work here");
  }
  return file;
}

// In the child: becomes the engine. Its process group is its own, so that one signal reaches it and
// its jobs; if this program is killed, the engine ends its jobs and stops.
[[noreturn]] void become(std::vector<std::string> command, const fs::path& output) {
  std::signal(SIGINT, SIG_DFL);  // what comes before the engine is there must not be lost
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  dup2(STDERR_FILENO, STDOUT_FILENO);
  const int nothing = open("/dev/null", O_RDONLY);
  if (nothing >= 0) dup2(nothing, STDIN_FILENO);
  setenv("PYTHONDONTWRITEBYTECODE", "1", 1);
  setenv("XDG_CACHE_HOME", (output / ".cache").c_str(), 1);  // nothing outside the folder
  std::vector<char*> words;
  words.reserve(command.size() + 1);
  for (std::string& word : command) words.push_back(word.data());
  words.push_back(nullptr);
  execvp(words[0], words.data());
  _exit(127);
}

// Runs the engine to its end and returns its exit code; Ctrl-C goes on to it.
int run_engine(const std::vector<std::string>& command, const fs::path& output,
               const TerminalObserver& observer) {
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0)
    throw LimitError(std::string("no process can be started: ") + std::strerror(errno));
  if (child == 0) become(command, output);
  setpgid(child, child);  // whichever of the two is first
  // A signal may come at any time, also just before a wait that would outlast it.
  constexpr timespec kPause{0, 50'000'000};
  int status = 0;
  bool told = false;
  while (true) {
    const pid_t ended = waitpid(child, &status, WNOHANG);
    if (ended == child) break;
    if (ended < 0 && errno != EINTR) {
      throw LimitError(std::string("waitpid: ") + std::strerror(errno));
    }
    if (observer.cancelled() && !told) {
      kill(-child, SIGINT);
      told = true;
    }
    nanosleep(&kPause, nullptr);
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string shown(const std::string& word) {
  return word.find_first_of(" \t'\"$") == std::string::npos ? word : "'" + word + "'";
}

std::optional<std::string> text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(file), {});
}

int run_bench(const BenchArguments& a) {
  require_writable({a.common.json});
  const fs::path workflow = find_workflow(a.workflow);
  const fs::path suite = find_suite(a.suite, workflow);
  require_program("snakemake");
  const fs::path output =
      a.output.empty() ? build_folder(workflow) / "bench" / suite.stem() : fs::absolute(a.output);
  std::error_code failure;
  fs::create_directories(output, failure);
  if (failure) throw OutputError(failure.message(), output.string());
  const int lock = lock_folder(output);
  const std::vector<std::string> command = engine_command(a, workflow, suite, output);
  if (!a.common.quiet) {
    std::string line;
    for (const std::string& word : command) line += (line.empty() ? "" : " ") + shown(word);
    fmt::print(stderr, "{}\n", line);
  }
  const TerminalObserver observer(a.common);
  const int code = run_engine(command, output, observer);
  close(lock);
  if (observer.cancelled()) throw Cancelled();
  if (a.dry_run && code == 0) return kDone;
  if (code == kBadInput) return kBadInput;  // the workflow has said what is wrong with the suite
  if (code != 0) {
    print_error(suite.string() + ": the engine stopped (exit code " + std::to_string(code) +
                "); what was done is kept, the same command goes on; its log is in " +
                (output / ".snakemake" / "log").string());
    return kNoGuarantee;
  }
  const auto results = text_of(output / "results.json");
  const auto table = text_of(output / "table.md");
  if (!results || !table) throw InputError("the engine wrote no tables", output.string());
  if (!a.common.json.empty()) write_text(a.common.json, *results);
  if (!a.common.quiet && a.common.json != "-") fmt::print("{}", *table);
  return kDone;
}

}  // namespace

Command add_bench(CLI::App& program) {
  CLI::App* app = program.add_subcommand(
      "bench",
      "A suite of meshes and methods, run by Snakemake: a job for each mesh and method with limits "
      "of time and memory, tables and plots. The same command goes on after a kill");
  auto arguments = std::make_shared<BenchArguments>();
  BenchArguments& a = *arguments;
  app->add_option("suite", a.suite, "A suite's YAML file, or the name of one of tools/bench/suites")
      ->required();
  app->add_option("-o,--output", a.output, "Folder of the results (default: build/bench/SUITE)");
  app->add_option("--datasets", a.datasets,
                  "Folder of the data sets, installed where missing (default: build/datasets)");
  app->add_option("--profile", a.profile,
                  "Snakemake profile in place of the local cores: slurm, or a folder");
  app->add_option("--snakemake", a.engine, "A further argument for Snakemake; may be repeated")
      ->allow_extra_args(false);
  app->add_option("--workflow", a.workflow,
                  "Folder of the Snakefile (default: that of this program)");
  a.common.add_to(*app);
  app->add_flag("--dry-run", a.dry_run, "Only say what would run")->excludes("--json");
  return {app, [arguments] { return run_bench(*arguments); },
          [arguments] { return arguments->suite; }};
}

}  // namespace cellocut::tools
