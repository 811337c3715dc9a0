// Uses what was installed: a cut by every solver, a tetrahedralization by every backend, a VTU
// file.
#include <iostream>

#include "solvers/solvers.h"
#ifdef HAS_CORE
#include "backends/backends.h"
#endif
#ifdef HAS_VIZ
#include "viz/vtu_file.h"
#endif

namespace {

int failures = 0;

void expect(bool holds, const std::string& what) {
  if (holds) return;
  std::cerr << "failed: " << what << '\n';
  ++failures;
}

// source -5-> 0 -3-> 1 -4-> sink: the middle edge is the only minimum cut.
void solve_a_chain() {
  cellocut::CutProblem problem;
  problem.to_source = {5, 0};
  problem.to_sink = {0, 4};
  problem.edges = {{0, 1, 3, 0}};
  problem.constant = 10;
  int built = 0;
  for (const auto& variant : cellocut::solvers::registered()) {
    if (variant.make == nullptr) continue;
    ++built;
    const cellocut::CutResult result = variant.make()->solve(problem);
    expect(result.status == cellocut::CutStatus::optimal, variant.name + ": status");
    expect(result.value == 13, variant.name + ": value");
    expect(result.smallest_source_side == cellocut::CutLabels{1, 0}, variant.name + ": labels");
    expect(result.largest_source_side == cellocut::CutLabels{1, 0}, variant.name + ": labels");
  }
  expect(built > 0, "a solver is built");
}

#ifdef HAS_CORE
void tetrahedralize_five_points() {
  const std::vector<cellocut::Point3> points = {
      {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.25, 0.25, 0.25}};
  int built = 0;
  for (const auto& variant : cellocut::backends::registered()) {
    if (variant.make == nullptr) continue;
    ++built;
    const cellocut::TetComplex complex = variant.make()->tetrahedralize(points);
    expect(complex.cells.size() == 4, variant.name + ": four cells");
#ifdef HAS_VIZ
    cellocut::viz::LabelledCells cells;
    cells.points = complex.points;
    cells.cells = complex.cells;
    cells.arrays = {{"label", std::vector<std::uint8_t>(complex.cells.size(), 1)}};
    expect(cellocut::viz::encode_vtu(cells).find("label") != std::string::npos, "VTU");
#endif
  }
  expect(built > 0, "a backend is built");
}
#endif

}  // namespace

int main() {
  solve_a_chain();
#ifdef HAS_CORE
  tetrahedralize_five_points();
#endif
  if (failures == 0) std::cout << "consumer: all checks passed\n";
  return failures == 0 ? 0 : 1;
}
