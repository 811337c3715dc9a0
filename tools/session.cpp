#include "tools/session.h"

#include <fmt/core.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <system_error>

#include "cellocut/base/atomic_file.h"
#include "cellocut/base/errors.h"

namespace cellocut::tools {

namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void on_interrupt(int signal) {
  if (interrupted.exchange(true)) {
    AtomicFile::remove_all_temporaries();
    _exit(signal == SIGINT ? 130 : 128 + signal);
  }
}

constexpr int kStages = 9;  // of a remesh, for the bar

}  // namespace

void CommonOptions::add_to(CLI::App& command) {
  command.add_option("--threads", threads, "Number of threads; the result does not depend on it")
      ->check(CLI::Range(1, 1024))
      ->default_str("all");
  CLI::Option* quiet_flag = command.add_flag("--quiet", quiet, "No progress, no summary");
  command.add_flag("--verbose", verbose, "A line on standard error for every stage")
      ->excludes(quiet_flag);
  command.add_option("--json", json, "Write a report to this file ('-': standard output)");
}

TerminalObserver::TerminalObserver(const CommonOptions& options)
    : bar_(!options.quiet && !options.verbose && isatty(STDERR_FILENO) != 0),
      lines_(options.verbose) {}

TerminalObserver::~TerminalObserver() { clear(); }

void TerminalObserver::stage(std::string_view name) {
  if (lines_) fmt::print(stderr, "cellocut: {}\n", name);
  if (!bar_) return;
  constexpr int kWidth = 24;
  const int filled = std::min(kWidth, kWidth * stages_ / kStages);
  fmt::print(stderr, "\r\033[K[{:#<{}}{:.<{}}] {}", "", filled, "", kWidth - filled, name);
  std::fflush(stderr);
  ++stages_;
  drawn_ = true;
}

void TerminalObserver::progress(double /*done*/) {}

bool TerminalObserver::cancelled() const { return interrupted.load(std::memory_order_relaxed); }

void TerminalObserver::clear() {
  if (!drawn_) return;
  fmt::print(stderr, "\r\033[K");
  drawn_ = false;
}

struct ThreadLimit::Control {
  tbb::global_control limit;
};

ThreadLimit::ThreadLimit(int threads)
    : threads_(threads > 0 ? threads : tbb::info::default_concurrency()) {
  control_ = std::unique_ptr<Control>(new Control{tbb::global_control(
      tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads_))});
}

ThreadLimit::~ThreadLimit() = default;

void install_signal_handlers() {
  struct sigaction action {};
  action.sa_handler = on_interrupt;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
}

void require_writable(const std::vector<std::string>& paths) {
  for (std::size_t i = 0; i < paths.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!paths[i].empty() && paths[i] == paths[j]) {
        throw UsageError(paths[i] == "-" ? "only one output can be standard output"
                                         : paths[i] + ": two outputs cannot be the same file");
      }
    }
  }
  for (const std::string& path : paths) {
    if (path.empty() || path == "-") continue;
    try {
      const AtomicFile probe(path);
    } catch (const OutputError& error) {
      throw UsageError(error.file() + ": " + error.what());
    }
  }
}

TriangleSoup read_input(const std::string& path, const std::string& format) {
  std::error_code unknown;
  if (std::filesystem::is_directory(path, unknown)) throw InputError("is a directory", path);
  std::optional<MeshFormat> named;
  if (!format.empty()) named = format_of_name(format);
  return read_mesh(path, named);
}

void write_text(const std::string& path, const std::string& text) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace cellocut::tools
