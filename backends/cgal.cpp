// CGAL's incremental Delaunay triangulation with exact predicates.
//
// Points go in along a Hilbert curve, in rounds of growing size (Amenta, Choi and Rote,
// "Incremental constructions con BRIO", 2003), so that locating the next one takes constant time in
// practice. Ties between co-spherical points are broken by symbolic perturbation in lexicographic
// order (Devillers and Teillaud, "Perturbations for Delaunay and weighted Delaunay 3D
// triangulations", 2011): the result depends on the coordinates alone, not on the order of the
// points.
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <utility>

#include "backends/backends.h"

namespace cellocut::backends {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
using CellBase = CGAL::Delaunay_triangulation_cell_base_3<Kernel>;
using Delaunay =
    CGAL::Delaunay_triangulation_3<Kernel,
                                   CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;

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
  [[nodiscard]] std::vector<std::array<std::uint32_t, 4>> do_tetrahedralize(
      const std::vector<Point3>& points) const override {
    std::vector<std::pair<Kernel::Point_3, std::uint32_t>> indexed;
    indexed.reserve(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      indexed.emplace_back(Kernel::Point_3(points[i][0], points[i][1], points[i][2]), i);
    }
    try {
      const Delaunay triangulation(indexed.begin(), indexed.end());
      if (triangulation.number_of_vertices() != points.size()) {
        throw Error("cgal: " + std::to_string(points.size() - triangulation.number_of_vertices()) +
                    " points are missing from the triangulation");
      }
      std::vector<std::array<std::uint32_t, 4>> cells;
      cells.reserve(triangulation.number_of_finite_cells());
      for (const auto& cell : triangulation.finite_cell_handles()) {
        cells.push_back({cell->vertex(0)->info(), cell->vertex(1)->info(), cell->vertex(2)->info(),
                         cell->vertex(3)->info()});
      }
      return cells;
    } catch (const CGAL::Failure_exception& failure) {
      throw Error(std::string("cgal: ") + failure.what());
    }
  }
};

}  // namespace

std::unique_ptr<Tetrahedralizer> make_cgal() { return std::make_unique<CgalTetrahedralizer>(); }

}  // namespace cellocut::backends
