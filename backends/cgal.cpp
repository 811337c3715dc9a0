// CGAL's incremental Delaunay triangulation with exact predicates.
//
// Points go in along a Hilbert curve, in rounds of growing size (Amenta, Choi and Rote,
// "Incremental constructions con BRIO", 2003), so that locating the next one takes constant time in
// practice. Ties between co-spherical points are broken by symbolic perturbation in lexicographic
// order (Devillers and Teillaud, "Perturbations for Delaunay and weighted Delaunay 3D
// triangulations", 2011): the result depends on the coordinates alone, not on the order of the
// points, and so several threads may insert at once.
#define CGAL_LINKED_WITH_TBB
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <tbb/global_control.h>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "backends/backends.h"

namespace cellocut::backends {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
using CellBase = CGAL::Delaunay_triangulation_cell_base_3<Kernel>;

template <class Concurrency>
using Delaunay = CGAL::Delaunay_triangulation_3<
    Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase, Concurrency>>;

using IndexedPoints = std::vector<std::pair<Kernel::Point_3, std::uint32_t>>;
using Cells = std::vector<std::array<std::uint32_t, 4>>;

template <class Triangulation>
Cells cells_of(const Triangulation& triangulation, std::size_t points) {
  if (triangulation.number_of_vertices() != points) {
    throw Error("cgal: " + std::to_string(points - triangulation.number_of_vertices()) +
                " points are missing from the triangulation");
  }
  Cells cells;
  cells.reserve(triangulation.number_of_finite_cells());
  for (const auto& cell : triangulation.finite_cell_handles()) {
    cells.push_back({cell->vertex(0)->info(), cell->vertex(1)->info(), cell->vertex(2)->info(),
                     cell->vertex(3)->info()});
  }
  return cells;
}

Cells insert_alone(const IndexedPoints& points) {
  return cells_of(Delaunay<CGAL::Sequential_tag>(points.begin(), points.end()), points.size());
}

// Each thread locks the blocks of a grid over the points that it works in.
Cells insert_together(const IndexedPoints& points) {
  constexpr int kBlocks = 50;  // along each axis, as CGAL's manual has it
  using Triangulation = Delaunay<CGAL::Parallel_tag>;
  CGAL::Bbox_3 box = points.front().first.bbox();
  for (const auto& [point, index] : points) box += point.bbox();
  Triangulation::Lock_data_structure locks(box, kBlocks);
  return cells_of(Triangulation(points.begin(), points.end(), &locks), points.size());
}

// With locks one thread takes 1.4 times as long as without, two take 0.75 times (142,175 and
// 995,220 vertices of a surface); fewer points are a matter of milliseconds.
bool worth_locking(const IndexedPoints& points) {
  using Control = tbb::global_control;
  return points.size() > 10000 && Control::active_value(Control::max_allowed_parallelism) > 1;
}

class CgalTetrahedralizer final : public Tetrahedralizer {
 public:
  [[nodiscard]] const TetrahedralizerInfo& info() const override {
    static const TetrahedralizerInfo info{
        "cgal", "CGAL Delaunay_triangulation_3, exact predicates, ties by symbolic perturbation",
        "GPL-3.0-or-later",
        "Jamin, Pion, Teillaud: 3D Triangulations. CGAL User and Reference Manual, 5.5, 2022"};
    return info;
  }

 private:
  [[nodiscard]] Cells do_tetrahedralize(const std::vector<Point3>& points) const override {
    IndexedPoints indexed;
    indexed.reserve(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      indexed.emplace_back(Kernel::Point_3(points[i][0], points[i][1], points[i][2]), i);
    }
    try {
      return worth_locking(indexed) ? insert_together(indexed) : insert_alone(indexed);
    } catch (const CGAL::Failure_exception& failure) {
      throw Error(std::string("cgal: ") + failure.what());
    }
  }
};

}  // namespace

std::unique_ptr<Tetrahedralizer> make_cgal() { return std::make_unique<CgalTetrahedralizer>(); }

}  // namespace cellocut::backends
