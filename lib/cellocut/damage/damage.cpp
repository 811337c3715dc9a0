#include "cellocut/damage/damage.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "cellocut/base/random_stream.h"
#include "cellocut/damage/disc_patch.h"
#include "cellocut/measure/sampling.h"
#include "cellocut/validity/incidence.h"

namespace cellocut {

namespace {

constexpr int kTriesPerHole = 300;
constexpr double kLeastReached = 0.4;  // of the aimed area: below, another place is tried
constexpr double kMostReached = 2.5;
constexpr double kLeastLength = 0.6;       // of the aimed length, for bands
constexpr double kMostOfAComponent = 0.3;  // of its area

void require_watertight(const TriangleSoup& model) {
  if (model.empty()) throw InputError("no faces");
  const Incidence incidence = count_incidence(
      model.triangles, corners_by_point(model.triangles, model.points.size()), silent_observer());
  const IncidenceCounts& counts = incidence.counts;
  const auto repeated = static_cast<std::int64_t>(model.triangles.size()) - incidence.proper_faces;
  const std::int64_t wrong = counts.boundary_edges + counts.nonmanifold_edges +
                             counts.misoriented_edges + counts.nonmanifold_vertices + repeated;
  if (wrong == 0) return;
  throw InputError("not closed and manifold: " + std::to_string(counts.boundary_edges) +
                   " boundary edges, " + std::to_string(counts.nonmanifold_edges) +
                   " non-manifold edges, " + std::to_string(counts.nonmanifold_vertices) +
                   " non-manifold vertices, " + std::to_string(counts.misoriented_edges) +
                   " misoriented edges, " + std::to_string(repeated) +
                   " faces with a repeated corner");
}

// Random numbers one after another.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : stream_(seed) {}
  double unit() { return stream_(next_++); }
  double between(double low, double high) { return low + (high - low) * unit(); }
  Point3 direction() {
    const double height = between(-1, 1);
    const double angle = between(0, 2 * std::numbers::pi);
    const double radius = std::sqrt(std::fmax(0.0, 1 - height * height));
    return {radius * std::cos(angle), radius * std::sin(angle), height};
  }

 private:
  RandomStream stream_;
  std::uint64_t next_ = 0;
};

// What a try aims at.
struct Plan {
  std::uint32_t seed_face = 0;
  double area = 0;
  double length = 0;                 // of a band; 0 for a patch, and for what cannot be a band
  std::vector<std::uint8_t> wanted;  // by face
};

class Damager {
 public:
  Damager(const TriangleSoup& model, const DamageOptions& options)
      : model_(model),
        size_(options.size),
        dice_(options.seed),
        grower_(model),
        normals_(unit_normals(model)) {
    centres_.reserve(model.triangles.size());
    areas_.reserve(model.triangles.size());
    const auto& p = model.points;
    for (const Triangle& t : model.triangles) {
      centres_.push_back((1.0 / 3) * (p[t[0]] + p[t[1]] + p[t[2]]));
      areas_.push_back(triangle_area(p[t[0]], p[t[1]], p[t[2]]));
    }
    total_ = std::accumulate(areas_.begin(), areas_.end(), 0.0);
    component_ = count_incidence(model.triangles, corners_by_point(model.triangles, p.size()),
                                 silent_observer())
                     .component;
    component_area_.resize(areas_.size(), 0);
    for (std::size_t f = 0; f < areas_.size(); ++f) component_area_[component_[f]] += areas_[f];
    scan_lines_ = dice_.direction();
  }

  [[nodiscard]] bool has_area() const { return total_ > 0 && std::isfinite(total_); }
  std::size_t number(const DamageOptions& options) {
    const auto range = static_cast<double>(options.most - options.fewest + 1);
    return options.fewest +
           std::min(static_cast<std::size_t>(dice_.unit() * range), options.most - options.fewest);
  }

  // Tries one place.
  std::optional<Hole> try_hole(HoleKind kind) {
    const Plan plan = plan_hole(kind);
    if (plan.wanted.empty()) return std::nullopt;
    const Point3 centre = centres_[plan.seed_face];
    std::vector<std::uint32_t> disc = grower_.grow(
        plan.seed_face, plan.area, [&](std::uint32_t f) { return plan.wanted[f] != 0; },
        [&](std::uint32_t f) { return squared_norm(centres_[f] - centre); });
    double area = 0;
    for (const std::uint32_t f : disc) area += areas_[f];
    if (area < kLeastReached * plan.area || area > kMostReached * plan.area) return std::nullopt;
    if (area > kMostOfAComponent * component_area_[component_[plan.seed_face]]) return std::nullopt;
    Hole hole = describe(kind, std::move(disc), area);
    if (hole.length < kLeastLength * plan.length) return std::nullopt;
    grower_.keep_out(hole.faces);
    return hole;
  }

 private:
  // A face by its share of the area of those for which `from` is not 0 (null: all).
  std::uint32_t random_face(const std::vector<std::uint8_t>* from) {
    double sum = 0;
    for (std::size_t f = 0; f < areas_.size(); ++f) {
      if (from == nullptr || (*from)[f] != 0) sum += areas_[f];
    }
    double left = dice_.unit() * sum;
    std::uint32_t last = 0;
    for (std::uint32_t f = 0; f < areas_.size(); ++f) {
      if ((from != nullptr && (*from)[f] == 0) || areas_[f] <= 0) continue;
      last = f;
      left -= areas_[f];
      if (left < 0) break;
    }
    return last;
  }

  Plan plan_hole(HoleKind kind) {
    switch (kind) {
      case HoleKind::grazing:
        return plan_grazing();
      case HoleKind::gap: {
        const double length = size_ * std::sqrt(total_) * dice_.between(0.22, 0.4);
        return plan_band(length, length / dice_.between(5, 8), std::nullopt);
      }
      case HoleKind::stripe: {
        const double length = size_ * std::sqrt(total_) * dice_.between(0.15, 0.3);
        return plan_band(length, length / dice_.between(8, 15), scan_lines_);
      }
    }
    return {};
  }

  // The quarter of the area that is seen worst along a direction; of it, what is near a seed.
  Plan plan_grazing() {
    const Point3 view = dice_.direction();
    std::vector<std::pair<double, std::uint32_t>> slopes(areas_.size());
    for (std::uint32_t f = 0; f < slopes.size(); ++f) {
      slopes[f] = {std::fabs(dot(normals_[f], view)), f};
    }
    std::sort(slopes.begin(), slopes.end());
    double worst = 0;
    double area = 0;
    for (const auto& [slope, f] : slopes) {
      worst = slope;
      area += areas_[f];
      if (area >= 0.25 * total_) break;
    }
    Plan plan{.seed_face = 0,
              .area = size_ * size_ * total_ * dice_.between(0.008, 0.025),
              .length = 0,
              .wanted = {}};
    plan.wanted.resize(areas_.size());
    for (const auto& [slope, f] : slopes) plan.wanted[f] = slope <= worst ? 1 : 0;
    plan.seed_face = random_face(&plan.wanted);
    return plan;
  }

  // The band around a seed, on its side of the model: at most half a length from it, and half a
  // width, along the surface, from a plane through it. `across`: the normal of that plane; at right
  // angles to the seed's normal and else random where there is none. Faces that the plane cuts
  // belong to the band however wide they are, so that it holds together. Nothing is wanted where
  // the plane runs along the surface.
  Plan plan_band(double length, double width, std::optional<Point3> across) {
    Plan plan{
        .seed_face = random_face(nullptr), .area = length * width, .length = length, .wanted = {}};
    const Point3 centre = centres_[plan.seed_face];
    const Point3 normal = normals_[plan.seed_face];
    Point3 side = across ? *across : dice_.direction();
    const Point3 tangent = side - dot(side, normal) * normal;
    const double slope = norm(tangent);
    constexpr double kLeastSlope = 0.5;
    if (!(slope >= kLeastSlope)) return plan;
    // On the surface the same width is less across planes that meet it aslant.
    const double half_width = across ? slope * width / 2 : width / 2;
    if (!across) side = (1 / slope) * tangent;
    plan.wanted.resize(areas_.size());
    for (std::size_t f = 0; f < areas_.size(); ++f) {
      constexpr double kSameSide = 0.2;  // cosine
      if (norm(centres_[f] - centre) > length / 2 || dot(normals_[f], normal) < kSameSide) continue;
      double low = std::numeric_limits<double>::infinity();
      double high = -low;
      for (const std::uint32_t corner : model_.triangles[f]) {
        const double height = dot(model_.points[corner] - centre, side);
        low = std::min(low, height);
        high = std::max(high, height);
      }
      const bool within = std::fabs(dot(centres_[f] - centre, side)) <= half_width;
      plan.wanted[f] = within || (low <= 0 && high >= 0) ? 1 : 0;
    }
    return plan;
  }

  Hole describe(HoleKind kind, std::vector<std::uint32_t> disc, double area) const {
    Hole hole;
    hole.kind = kind;
    hole.area = area;
    hole.share = area / total_;
    for (const std::uint32_t f : disc) hole.centre = hole.centre + areas_[f] * centres_[f];
    hole.centre = (1 / area) * hole.centre;
    hole.boundary = grower_.boundary(disc);
    for (const std::uint32_t a : hole.boundary) {
      for (const std::uint32_t b : hole.boundary) {
        hole.length = std::max(hole.length, norm(model_.points[a] - model_.points[b]));
      }
    }
    hole.width = area / hole.length;
    hole.faces = std::move(disc);
    return hole;
  }

  const TriangleSoup& model_;
  double size_;
  Dice dice_;
  DiscGrower grower_;
  std::vector<Point3> normals_;
  std::vector<Point3> centres_;
  std::vector<double> areas_;
  double total_ = 0;
  std::vector<std::uint32_t> component_;
  std::vector<double> component_area_;  // by its lowest face
  Point3 scan_lines_{};                 // the normal of the stripes' planes
};

TriangleSoup without(const TriangleSoup& model, const std::vector<Hole>& holes) {
  std::vector<std::uint8_t> gone(model.triangles.size(), 0);
  for (const Hole& hole : holes) {
    for (const std::uint32_t f : hole.faces) gone[f] = 1;
  }
  std::vector<std::uint32_t> number(model.points.size(), 0);
  TriangleSoup result;
  for (std::size_t f = 0; f < model.triangles.size(); ++f) {
    if (gone[f] != 0) continue;
    result.triangles.push_back(model.triangles[f]);
    for (const std::uint32_t corner : model.triangles[f]) number[corner] = 1;
  }
  for (std::size_t v = 0; v < model.points.size(); ++v) {
    if (number[v] == 0) continue;
    number[v] = static_cast<std::uint32_t>(result.points.size());
    result.points.push_back(model.points[v]);
    if (!model.colours.empty()) result.colours.push_back(model.colours[v]);
  }
  for (Triangle& t : result.triangles) {
    for (std::uint32_t& corner : t) corner = number[corner];
  }
  return result;
}

}  // namespace

std::string to_string(HoleKind kind) {
  switch (kind) {
    case HoleKind::grazing:
      return "grazing";
    case HoleKind::gap:
      return "gap";
    case HoleKind::stripe:
      return "stripe";
  }
  return "";
}

void DamageOptions::validate() const {
  if (fewest < 1 || most > 1000 || fewest > most) {
    throw UsageError("holes must be MIN..MAX with 1 <= MIN <= MAX <= 1000");
  }
  if (!(size >= 0.01 && size <= 3)) throw UsageError("size must be 0.01 to 3");
}

Damage damage_mesh(const TriangleSoup& model, const DamageOptions& options, Observer& observer) {
  options.validate();
  require_watertight(model);
  Damager damager(model, options);
  if (!damager.has_area()) throw InputError("no face has an area");
  const std::size_t count = damager.number(options);
  Damage damage;
  for (std::size_t k = 0; k < count; ++k) {
    std::optional<Hole> hole;
    for (int tries = 0; tries < kTriesPerHole && !hole; ++tries) {
      observer.check();
      hole = damager.try_hole(static_cast<HoleKind>(k % 3));
    }
    if (hole) damage.holes.push_back(std::move(*hole));
  }
  if (damage.holes.size() < options.fewest) {
    throw InputError("too coarse for holes of these sizes: " + std::to_string(damage.holes.size()) +
                     " of " + std::to_string(count) + " found room among " +
                     std::to_string(model.triangles.size()) + " faces; subdivide it first");
  }
  damage.mesh = without(model, damage.holes);
  return damage;
}

}  // namespace cellocut
