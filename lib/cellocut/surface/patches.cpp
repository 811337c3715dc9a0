#include "cellocut/surface/patches.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace cellocut {

namespace {

constexpr std::uint8_t kFar = 255;

// Depth of every vertex of the surface up to `most`, kFar beyond.
std::vector<std::uint8_t> measure_depth(const TriangleSoup& surface,
                                        const std::vector<std::uint8_t>& supported, int most,
                                        const Observer& observer) {
  std::vector<std::uint8_t> depth(surface.points.size());
  std::transform(supported.begin(), supported.end(), depth.begin(),
                 [](std::uint8_t s) { return s != 0 ? kFar : std::uint8_t{0}; });
  for (int ring = 0; ring < most; ++ring) {
    observer.check();
    bool grown = false;
    for (const Triangle& t : surface.triangles) {
      const auto at_ring = [&](std::uint32_t v) { return depth[v] == ring; };
      if (!at_ring(t[0]) && !at_ring(t[1]) && !at_ring(t[2])) continue;
      for (const std::uint32_t v : t) {
        if (depth[v] != kFar) continue;
        depth[v] = static_cast<std::uint8_t>(ring + 1);
        grown = true;
      }
    }
    if (!grown) break;
  }
  return depth;
}

// The faces at every vertex that is nearer than kFar.
struct FacesAtVertices {
  std::vector<std::uint32_t> first;  // by vertex of the surface, and the end
  std::vector<std::uint32_t> face;

  FacesAtVertices(const TriangleSoup& surface, const std::vector<std::uint8_t>& depth)
      : first(surface.points.size() + 1, 0) {
    for (const Triangle& t : surface.triangles) {
      for (const std::uint32_t v : t) first[v + 1] += depth[v] != kFar ? 1U : 0U;
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    face.resize(first.back());
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::uint32_t f = 0; f < surface.triangles.size(); ++f) {
      for (const std::uint32_t v : surface.triangles[f]) {
        if (depth[v] != kFar) face[next[v]++] = f;
      }
    }
  }
};

class PatchFinder {
 public:
  PatchFinder(const TriangleSoup& surface, const std::vector<std::uint8_t>& supported, int margin,
              const Observer& observer)
      : surface_(surface),
        margin_(margin),
        depth_(measure_depth(surface, supported, margin + 1, observer)),
        faces_at_(surface, depth_) {}

  // Vertices of each connected region, ascending.
  [[nodiscard]] std::vector<std::vector<std::uint32_t>> regions() const {
    std::vector<std::vector<std::uint32_t>> regions;
    std::vector<bool> seen(surface_.points.size(), false);
    for (std::uint32_t v = 0; v < depth_.size(); ++v) {
      if (depth_[v] > margin_ || seen[v]) continue;
      std::vector<std::uint32_t> region{v};
      seen[v] = true;
      for (std::size_t i = 0; i < region.size(); ++i) {
        for_neighbours(region[i], [&](std::uint32_t w) {
          if (depth_[w] > margin_ || seen[w]) return;
          seen[w] = true;
          region.push_back(w);
        });
      }
      std::sort(region.begin(), region.end());
      regions.push_back(std::move(region));
    }
    return regions;
  }

  [[nodiscard]] FairingPatch make(std::vector<std::uint32_t> region) const {
    FairingPatch patch;
    patch.vertices = std::move(region);
    patch.movable = static_cast<std::uint32_t>(patch.vertices.size());
    Numbers numbers;
    for (std::uint32_t i = 0; i < patch.movable; ++i) numbers.emplace(patch.vertices[i], i);
    add_ring(patch, numbers, 0);
    patch.rows = static_cast<std::uint32_t>(patch.vertices.size());
    add_ring(patch, numbers, patch.movable);

    patch.depth.resize(patch.rows);
    std::vector<std::uint32_t> faces;
    for (std::uint32_t i = 0; i < patch.rows; ++i) {
      const std::uint32_t v = patch.vertices[i];
      patch.depth[i] = depth_[v];
      faces.insert(faces.end(), faces_at_.face.begin() + faces_at_.first[v],
                   faces_at_.face.begin() + faces_at_.first[v + 1]);
    }
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    patch.faces.reserve(faces.size());
    for (const std::uint32_t f : faces) {
      const Triangle& t = surface_.triangles[f];
      patch.faces.push_back({numbers.at(t[0]), numbers.at(t[1]), numbers.at(t[2])});
    }
    return patch;
  }

 private:
  using Numbers = std::unordered_map<std::uint32_t, std::uint32_t>;

  template <class Visit>
  void for_neighbours(std::uint32_t v, const Visit& visit) const {
    for (std::uint32_t i = faces_at_.first[v]; i < faces_at_.first[v + 1]; ++i) {
      for (const std::uint32_t w : surface_.triangles[faces_at_.face[i]]) visit(w);
    }
  }

  // Appends the neighbours of the patch's vertices from number `first` on, ascending.
  void add_ring(FairingPatch& patch, Numbers& numbers, std::size_t first) const {
    std::vector<std::uint32_t> ring;
    for (std::size_t i = first; i < patch.vertices.size(); ++i) {
      for_neighbours(patch.vertices[i], [&](std::uint32_t w) {
        if (!numbers.contains(w)) ring.push_back(w);
      });
    }
    std::sort(ring.begin(), ring.end());
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    for (const std::uint32_t w : ring) {
      numbers.emplace(w, static_cast<std::uint32_t>(patch.vertices.size()));
      patch.vertices.push_back(w);
    }
  }

  const TriangleSoup& surface_;
  int margin_;
  std::vector<std::uint8_t> depth_;
  FacesAtVertices faces_at_;
};

}  // namespace

std::vector<FairingPatch> find_patches(const TriangleSoup& surface,
                                       const std::vector<std::uint8_t>& supported, int margin_rings,
                                       const Observer& observer) {
  if (std::find(supported.begin(), supported.end(), 0) == supported.end()) return {};
  const PatchFinder finder(surface, supported, margin_rings, observer);
  std::vector<std::vector<std::uint32_t>> regions = finder.regions();
  std::vector<FairingPatch> patches(regions.size());
  tbb::parallel_for(std::size_t{0}, regions.size(), [&](std::size_t i) {
    observer.check();
    patches[i] = finder.make(std::move(regions[i]));
  });
  return patches;
}

}  // namespace cellocut
