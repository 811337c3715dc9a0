// How close a mesh is to a reference: the distances and normals that the literature compares by.
//
// All lengths are relative: mesh and reference are shifted and scaled together so that the longest
// edge of the reference's bounding box is 1. Every measure comes in two kinds. "Sampled" compares
// random points on both shapes with one another, as published tables do; at 100,000 samples the
// gaps between them dominate it below 0.005. "To surface" (`_p2s`) takes the same random points to
// the nearest point of the other surface itself and has no such floor.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "cellocut/base/observer.h"
#include "cellocut/mesh/point_cloud.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

struct EvaluationOptions {
  std::size_t samples = 100'000;  // on each mesh; 1 to 10^8
  std::uint64_t seed = 1;         // mesh and reference draw from different streams of it
  // Of the F-score, relative; finite, above 0.
  std::vector<double> thresholds{0.001, 0.005, 0.01, 0.02};

  // Errors: UsageError that names the option and what it may be.
  void validate() const;
};

// Of the distances from all samples of one shape to the other, relative.
struct DistanceSummary {
  double mean = 0;
  double mean_square = 0;
  double median = 0;  // quantiles interpolate linearly between neighbours in order
  double p95 = 0;     // the 95th percentile
  double largest = 0;
  bool operator==(const DistanceSummary&) const = default;
};

// One kind of measure. What a reference does not allow is absent: a point cloud has no surface to
// measure to, and perhaps no normals.
struct Agreement {
  std::optional<DistanceSummary> to_reference;    // from the samples of the mesh
  std::optional<DistanceSummary> from_reference;  // from those of the reference
  // CD: the two mean squares, summed.
  std::optional<double> chamfer;
  // HD: the larger of the two largest.
  std::optional<double> hausdorff;
  // The absolute cosine between the normals at a sample and at its nearest point, mean over the
  // samples with two normals. To a surface the normal is that of the face; where the nearest point
  // is on an edge or a corner, rounding decides between its faces.
  std::optional<double> normals_to_reference;
  std::optional<double> normals_from_reference;
  // ANC, 0 to 1: the mean of both.
  std::optional<double> normal_consistency;
  // F1 in percent, one for each threshold (empty: absent): the harmonic mean of the shares of
  // samples, each way, that lie nearer than the threshold (Knapitsch et al., Tanks and Temples,
  // 2017).
  std::vector<double> f1;
  bool operator==(const Agreement&) const = default;
};

struct Evaluation {
  Agreement sampled;
  Agreement to_surface;
  bool operator==(const Evaluation&) const = default;
};

// Holds a reference and what is searched in it, for any number of meshes. The same bits for any
// number of threads and any power of two by which both shapes are scaled.
//
// Faces without area take no part: no sample falls on them, and they have no normal.
class Evaluator {
 public:
  // Errors: UsageError by options.validate(); InputError where the reference has no face with an
  // area, no extent, or coordinates that are not finite. Parallel; O(n log n).
  Evaluator(const TriangleSoup& reference, EvaluationOptions options);
  // The points themselves are the samples of the reference. Errors: as above, no points.
  Evaluator(const PointCloud& reference, EvaluationOptions options);
  ~Evaluator();
  Evaluator(Evaluator&&) noexcept;
  Evaluator& operator=(Evaluator&&) noexcept;

  // The longest edge of the reference's box, in input units: times this, a relative length is one
  // in input units.
  [[nodiscard]] double unit() const;

  // Errors: InputError where no face of the mesh has an area, or a coordinate is not finite or so
  // large that its relative square is not; Cancelled. Parallel; O((n + samples) log n).
  [[nodiscard]] Evaluation operator()(const TriangleSoup& mesh,
                                      const Observer& observer = silent_observer()) const;

 private:
  struct Reference;
  std::unique_ptr<Reference> reference_;
  EvaluationOptions options_;
};

}  // namespace cellocut
