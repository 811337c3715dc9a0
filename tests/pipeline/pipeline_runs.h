// A whole run for tests, and what every run has to keep.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "backends/backends.h"
#include "cellocut/pipeline.h"
#include "solvers/solvers.h"

namespace cellocut::testing {

inline RemeshResult run(const TriangleSoup& input, const RemeshOptions& options,
                        const std::string& backend = "cgal", const std::string& solver = "bk") {
  return remesh(input, options, *backends::make(backend), *solvers::make(solver));
}

inline RemeshOptions at_resolution(int resolution, SurfaceMode surface = SurfaceMode::union_) {
  RemeshOptions options;
  options.resolution = resolution;
  options.surface = surface;
  return options;
}

inline void expect_sound(const RemeshResult& result) {
  EXPECT_EQ(result.cut.status, CutStatus::optimal) << result.cut.message;
  for (const CertificateCheck& check : result.certificate.checks) {
    EXPECT_TRUE(check.passed) << check.name << ": " << check.detail;
  }
  EXPECT_TRUE(result.certificate.valid);
  const SurfaceReport& report = result.surface_report;
  EXPECT_TRUE(report.valid());
  EXPECT_EQ(report.by_index.boundary_edges, 0);
  EXPECT_EQ(report.by_index.nonmanifold_edges, 0);
  EXPECT_EQ(report.by_index.misoriented_edges, 0);
  EXPECT_EQ(report.by_index.nonmanifold_vertices, 0);
  EXPECT_EQ(report.by_index.duplicate_faces, 0);
  EXPECT_EQ(report.degenerate_faces, 0);
  EXPECT_EQ(report.nonfinite_points, 0);
  EXPECT_EQ(report.intersecting_pairs, 0);
  EXPECT_GT(report.volume, 0);
  EXPECT_LE(result.proxy.largest_distance, kProxyTolerance);
}

// In squared relative units.
inline double relative_energy(const RemeshResult& result, const RemeshOptions& options) {
  return static_cast<double>(result.cut.value) /
         (static_cast<double>(options.lambda_fill.denominator) * result.areas.scale);
}

}  // namespace cellocut::testing
