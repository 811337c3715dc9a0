#include "cellocut/measure/evaluation.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "cellocut/base/errors.h"
#include "cellocut/measure/nearest_sample.h"
#include "cellocut/measure/nearest_triangle.h"
#include "cellocut/measure/sampling.h"

namespace cellocut {

namespace {

// Relative coordinates.
struct RelativeFrame {
  Point3 centre{};
  double unit = 1;

  explicit RelativeFrame(const Box3& box)
      : centre(0.5 * box.low + 0.5 * box.high), unit(box.longest_edge()) {
    if (!(unit > 0)) throw InputError("has no extent: all points are in one place");
    if (!std::isfinite(unit)) throw InputError("a coordinate is not finite, or too large");
  }

  // Errors: InputError where squares of squares, as areas need them, would not be finite.
  [[nodiscard]] Point3 operator()(const Point3& p) const {
    constexpr double kFarthest = 1e70;
    Point3 q;
    for (int axis = 0; axis < 3; ++axis) {
      q[axis] = (p[axis] - centre[axis]) / unit;
      if (!(std::fabs(q[axis]) < kFarthest)) {
        throw InputError("a coordinate is not finite, or too large beside the reference");
      }
    }
    return q;
  }
};

// The faces that have an area, in relative coordinates. Points that no face uses are left at 0.
TriangleSoup relative_soup(const TriangleSoup& soup, const RelativeFrame& frame) {
  TriangleSoup result;
  result.points.resize(soup.points.size());
  for (const Triangle& t : soup.triangles) {
    for (const std::uint32_t corner : t) result.points[corner] = frame(soup.points[corner]);
    const auto& p = result.points;
    if (triangle_area(p[t[0]], p[t[1]], p[t[2]]) > 0) result.triangles.push_back(t);
  }
  return result;
}

Box3 box_of(const std::vector<Point3>& points) {
  if (points.empty()) throw InputError("no points");
  return bounding_box(points);
}

Box3 box_of(const TriangleSoup& soup) {
  if (soup.empty()) throw InputError("no faces");
  return bounding_box(soup);
}

// Samples, and what other samples are taken to.
struct Shape {
  Samples samples;
  NearestSample nearest_sample;
  std::optional<NearestTriangle> surface;  // absent for a point cloud
  std::vector<Point3> face_normals;

  Shape(const TriangleSoup& relative, std::size_t count, std::uint64_t seed)
      : samples(sample_surface(relative, count, seed)),
        nearest_sample(samples.points),
        surface(relative),
        face_normals(unit_normals(relative)) {}
  explicit Shape(Samples points) : samples(std::move(points)), nearest_sample(samples.points) {}
};

Samples relative_samples(const PointCloud& cloud, const RelativeFrame& frame) {
  Samples samples;
  samples.points.reserve(cloud.points.size());
  for (const Point3& p : cloud.points) samples.points.push_back(frame(p));
  samples.normals.reserve(cloud.normals.size());
  for (const Point3& n : cloud.normals) {
    // By the largest component first, whose square neither overflows nor underflows.
    const double largest = std::max({std::fabs(n[0]), std::fabs(n[1]), std::fabs(n[2])});
    if (!std::isfinite(largest)) throw InputError("a normal is not finite");
    if (largest == 0) {
      samples.normals.push_back({0, 0, 0});
      continue;
    }
    const Point3 scaled{n[0] / largest, n[1] / largest, n[2] / largest};
    samples.normals.push_back((1 / norm(scaled)) * scaled);
  }
  return samples;
}

// From every sample of one shape to the other.
struct OneWay {
  std::vector<double> distances;
  std::vector<double> cosines;  // absolute; kNoNormals where one has no normal
  static constexpr double kNoNormals = -1;
};

double absolute_cosine(const Point3& a, const Point3& b) {
  if (squared_norm(a) == 0 || squared_norm(b) == 0) return OneWay::kNoNormals;
  return std::min(std::fabs(dot(a, b)), 1.0);
}

// nearest(p) is the distance to the nearest point and the normal there (null: none).
template <class Nearest>
OneWay measure(const Samples& from, const Observer& observer, const Nearest& nearest) {
  OneWay result;
  result.distances.resize(from.size());
  result.cosines.resize(from.size(), OneWay::kNoNormals);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, from.size(), 256), [&](const auto& range) {
    observer.check();
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const std::pair<double, const Point3*> found = nearest(from.points[i]);
      result.distances[i] = found.first;
      if (found.second == nullptr || from.normals.empty()) continue;
      result.cosines[i] = absolute_cosine(from.normals[i], *found.second);
    }
  });
  return result;
}

OneWay measure_to_samples(const Samples& from, const Shape& to, const Observer& observer) {
  return measure(from, observer, [&](const Point3& p) {
    const NearestSample::Result found = to.nearest_sample(p);
    const std::vector<Point3>& normals = to.samples.normals;
    return std::pair{found.distance, normals.empty() ? nullptr : &normals[found.index]};
  });
}

std::optional<OneWay> measure_to_surface(const Samples& from, const Shape& to,
                                         const Observer& observer) {
  if (!to.surface) return std::nullopt;
  return measure(from, observer, [&](const Point3& p) {
    const NearestPoint found = (*to.surface)(p);
    return std::pair{found.distance, &to.face_normals[found.face]};
  });
}

// Linear between neighbours, as most statistics packages have it (type 7 of Hyndman and Fan, 1996).
double quantile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

// Sums are taken in the order of the samples.
DistanceSummary summarise(std::vector<double> distances) {
  DistanceSummary summary;
  for (const double d : distances) {
    summary.mean += d;
    summary.mean_square += d * d;
  }
  summary.mean /= static_cast<double>(distances.size());
  summary.mean_square /= static_cast<double>(distances.size());
  tbb::parallel_sort(distances.begin(), distances.end());
  summary.median = quantile(distances, 0.5);
  summary.p95 = quantile(distances, 0.95);
  summary.largest = distances.back();
  return summary;
}

std::optional<double> mean_cosine(const std::vector<double>& cosines) {
  double sum = 0;
  std::size_t count = 0;
  for (const double c : cosines) {
    if (c == OneWay::kNoNormals) continue;
    sum += c;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / static_cast<double>(count);
}

double share_below(const std::vector<double>& distances, double threshold) {
  const auto count = std::count_if(distances.begin(), distances.end(),
                                   [threshold](double d) { return d < threshold; });
  return static_cast<double>(count) / static_cast<double>(distances.size());
}

double f1_percent(const OneWay& to, const OneWay& from, double threshold) {
  const double precision = share_below(to.distances, threshold);
  const double recall = share_below(from.distances, threshold);
  return precision + recall > 0 ? 100 * (2 * precision * recall / (precision + recall)) : 0.0;
}

Agreement agreement(const std::optional<OneWay>& to, const std::optional<OneWay>& from,
                    const std::vector<double>& thresholds) {
  Agreement result;
  if (to) {
    result.to_reference = summarise(to->distances);
    result.normals_to_reference = mean_cosine(to->cosines);
  }
  if (from) {
    result.from_reference = summarise(from->distances);
    result.normals_from_reference = mean_cosine(from->cosines);
  }
  if (!to || !from) return result;
  result.chamfer = result.to_reference->mean_square + result.from_reference->mean_square;
  result.hausdorff = std::max(result.to_reference->largest, result.from_reference->largest);
  if (result.normals_to_reference && result.normals_from_reference) {
    result.normal_consistency =
        0.5 * (*result.normals_to_reference + *result.normals_from_reference);
  }
  for (const double threshold : thresholds) {
    result.f1.push_back(f1_percent(*to, *from, threshold));
  }
  return result;
}

// The two streams of a seed: if both shapes drew the same numbers, equal meshes would get equal
// samples, and measures between samples would hide what sampling costs.
std::uint64_t reference_stream(std::uint64_t seed) { return 2 * seed; }
std::uint64_t mesh_stream(std::uint64_t seed) { return 2 * seed + 1; }

}  // namespace

void EvaluationOptions::validate() const {
  constexpr std::size_t kMostSamples = 100'000'000;
  if (samples < 1 || samples > kMostSamples) {
    throw UsageError("samples must be 1 to " + std::to_string(kMostSamples));
  }
  for (const double threshold : thresholds) {
    if (!(threshold > 0) || !std::isfinite(threshold)) {
      throw UsageError("a threshold must be a positive number");
    }
  }
}

struct Evaluator::Reference {
  RelativeFrame frame;
  Shape shape;

  Reference(const TriangleSoup& soup, const EvaluationOptions& options)
      : frame(box_of(soup)),
        shape(relative_soup(soup, frame), options.samples, reference_stream(options.seed)) {}
  explicit Reference(const PointCloud& cloud)
      : frame(box_of(cloud.points)), shape(relative_samples(cloud, frame)) {}
};

Evaluator::Evaluator(const TriangleSoup& reference, EvaluationOptions options)
    : options_(std::move(options)) {
  options_.validate();
  reference_ = std::make_unique<Reference>(reference, options_);
}

Evaluator::Evaluator(const PointCloud& reference, EvaluationOptions options)
    : options_(std::move(options)) {
  options_.validate();
  reference_ = std::make_unique<Reference>(reference);
}

Evaluator::~Evaluator() = default;
Evaluator::Evaluator(Evaluator&&) noexcept = default;
Evaluator& Evaluator::operator=(Evaluator&&) noexcept = default;

double Evaluator::unit() const { return reference_->frame.unit; }

Evaluation Evaluator::operator()(const TriangleSoup& mesh, const Observer& observer) const {
  const Shape& reference = reference_->shape;
  const Shape shape(relative_soup(mesh, reference_->frame), options_.samples,
                    mesh_stream(options_.seed));
  Evaluation result;
  result.sampled =
      agreement(measure_to_samples(shape.samples, reference, observer),
                measure_to_samples(reference.samples, shape, observer), options_.thresholds);
  result.to_surface =
      agreement(measure_to_surface(shape.samples, reference, observer),
                measure_to_surface(reference.samples, shape, observer), options_.thresholds);
  return result;
}

}  // namespace cellocut
