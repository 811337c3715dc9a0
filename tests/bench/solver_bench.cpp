// Seconds for building and solving, for every solver that is built, on generated problems of the
// size of a remesh. All solvers take turns on the same problem in one run, so that their ratios can
// be compared where absolute times cannot; the fastest of the rounds counts.
//
//   solver_bench [SIDE [ROUNDS [SOLVER...]]]     about SIDE^3 nodes, 67 by default; 5 rounds; all
//   solvers
//                                                but lemon_preflow, which is slow
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "solvers/solvers.h"
#include "support/cut_problems.h"

namespace {

using cellocut::CutProblem;
using cellocut::CutResult;
using cellocut::CutStatus;

struct Row {
  std::string solver;
  CutResult best;
  [[nodiscard]] double seconds() const { return best.build_seconds + best.solve_seconds; }
};

bool measure(const std::string& name, const CutProblem& problem, std::vector<Row> rows,
             int rounds) {
  std::printf("%s: %zu nodes, %zu edges\n", name.c_str(), problem.node_count(),
              problem.edges.size());
  for (int round = 0; round < rounds; ++round) {
    for (Row& row : rows) {
      CutResult result = cellocut::solvers::make(row.solver)->solve(problem);
      if (round == 0 || result.build_seconds + result.solve_seconds < row.seconds()) {
        row.best = std::move(result);
      }
    }
  }
  bool agree = true;
  const auto reference = std::find_if(rows.begin(), rows.end(),
                                      [](const Row& row) { return row.solver == "libmaxflow"; });
  for (const Row& row : rows) {
    agree = agree && row.best.status == CutStatus::optimal &&
            row.best.value == rows.front().best.value &&
            row.best.smallest_source_side == rows.front().best.smallest_source_side &&
            row.best.largest_source_side == rows.front().best.largest_source_side;
    std::printf("  %-14s build %8.4f s  solve %8.4f s  sum %8.4f s", row.solver.c_str(),
                row.best.build_seconds, row.best.solve_seconds, row.seconds());
    if (reference != rows.end()) {
      std::printf("  %6.2f x libmaxflow", row.seconds() / reference->seconds());
    }
    for (const auto& [counter, count] : row.best.counters) {
      std::printf("  %s %lld", counter.c_str(), static_cast<long long>(count));
    }
    std::printf("\n");
  }
  if (!agree) std::printf("  the solvers do not agree\n");
  return agree;
}

}  // namespace

int main(int argc, char** argv) {
  const auto side = static_cast<std::uint32_t>(argc > 1 ? std::atoi(argv[1]) : 67);
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 5;
  if (side < 4 || side > 500 || rounds < 1) {
    std::fprintf(stderr, "usage: solver_bench [SIDE [ROUNDS [SOLVER...]]]\n");
    return 2;
  }
  std::vector<Row> rows;
  for (int k = 3; k < argc; ++k) rows.push_back({argv[k], {}});
  if (rows.empty()) {
    for (const auto& variant : cellocut::solvers::registered()) {
      if (variant.make != nullptr && variant.name != "lemon_preflow") {
        rows.push_back({variant.name, {}});
      }
    }
  }
  try {
    bool agree = measure("sheet", cellocut::testing::sheet_problem(side, 1), rows, rounds);
    agree = measure("noisy_ball", cellocut::testing::noisy_ball_problem(side, 1), rows, rounds) &&
            agree;
    return agree ? 0 : 1;
  } catch (const cellocut::Error& error) {
    std::fprintf(stderr, "solver_bench: %s\n", error.what());
    return 2;
  }
}
