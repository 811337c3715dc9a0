#include "cellocut/damage/disc_patch.h"

#include <algorithm>
#include <tuple>
#include <unordered_map>

namespace cellocut {

DiscGrower::DiscGrower(const TriangleSoup& mesh)
    : mesh_(mesh),
      neighbour_(mesh.triangles.size(), {kNone, kNone, kNone}),
      kept_out_(mesh.points.size(), 0),
      in_disc_(mesh.triangles.size(), 0),
      vertex_in_disc_(mesh.points.size(), 0) {
  std::vector<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, int>> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
      edges.emplace_back(low, high, f, k);
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i + 1 < edges.size(); i += 2) {
    const auto& [low, high, f, k] = edges[i];
    const auto& [low_too, high_too, g, l] = edges[i + 1];
    neighbour_[f][k] = g;
    neighbour_[g][l] = f;
  }
}

bool DiscGrower::notch(std::uint32_t face) const {
  const auto& around = neighbour_[face];
  return std::count_if(around.begin(), around.end(),
                       [this](std::uint32_t next) { return in_disc_[next] != 0; }) >= 2;
}

bool DiscGrower::fits(std::uint32_t face) const {
  const Triangle& t = mesh_.triangles[face];
  int shared = 0;
  int opposite = 0;
  for (int k = 0; k < 3; ++k) {
    if (kept_out_[t[k]] != 0) return false;
    if (in_disc_[neighbour_[face][k]] == 0) continue;
    ++shared;
    opposite = (k + 2) % 3;
  }
  return shared == 2 || (shared == 1 && vertex_in_disc_[t[opposite]] == 0);
}

std::vector<std::uint32_t> DiscGrower::grow(std::uint32_t seed, double largest,
                                            const std::function<bool(std::uint32_t)>& wanted,
                                            const std::function<double(std::uint32_t)>& distance) {
  std::vector<std::uint32_t> disc;
  double area = 0;
  using Candidate = std::pair<double, std::uint32_t>;
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue;
  const auto add = [&](std::uint32_t face) {
    const Triangle& t = mesh_.triangles[face];
    const auto& p = mesh_.points;
    area += triangle_area(p[t[0]], p[t[1]], p[t[2]]);
    disc.push_back(face);
    in_disc_[face] = 1;
    for (const std::uint32_t corner : t) vertex_in_disc_[corner] = 1;
    // Whoever did not fit before gets another chance when a neighbour has come in.
    for (const std::uint32_t next : neighbour_[face]) {
      if (in_disc_[next] == 0 && (wanted(next) || notch(next))) {
        queue.emplace(distance(next), next);
      }
    }
  };
  const Triangle& first = mesh_.triangles[seed];
  if (std::none_of(first.begin(), first.end(), [&](auto v) { return kept_out_[v] != 0; })) {
    add(seed);
  }
  while (!queue.empty() && area < largest) {
    const std::uint32_t face = queue.top().second;
    queue.pop();
    if (in_disc_[face] == 0 && fits(face)) add(face);
  }
  for (const std::uint32_t face : disc) {
    in_disc_[face] = 0;
    for (const std::uint32_t corner : mesh_.triangles[face]) vertex_in_disc_[corner] = 0;
  }
  std::sort(disc.begin(), disc.end());
  return disc;
}

void DiscGrower::keep_out(const std::vector<std::uint32_t>& faces) {
  std::vector<std::uint8_t> near(mesh_.points.size(), 0);
  for (const std::uint32_t face : faces) {
    for (const std::uint32_t corner : mesh_.triangles[face]) near[corner] = 1;
  }
  for (const Triangle& t : mesh_.triangles) {
    if (near[t[0]] == 0 && near[t[1]] == 0 && near[t[2]] == 0) continue;
    for (const std::uint32_t corner : t) kept_out_[corner] = 1;
  }
}

std::vector<std::uint32_t> DiscGrower::boundary(const std::vector<std::uint32_t>& disc) const {
  std::unordered_map<std::uint32_t, std::uint32_t> next;
  for (const std::uint32_t face : disc) {
    const Triangle& t = mesh_.triangles[face];
    for (int k = 0; k < 3; ++k) {
      if (!std::binary_search(disc.begin(), disc.end(), neighbour_[face][k])) {
        next[t[k]] = t[(k + 1) % 3];
      }
    }
  }
  std::vector<std::uint32_t> loop;
  loop.reserve(next.size());
  // From the lowest: the order of a hash table decides nothing.
  std::uint32_t start = kNone;
  for (const auto& [from, to] : next) start = std::min(start, from);
  for (std::uint32_t v = start; loop.size() < next.size(); v = next[v]) loop.push_back(v);
  return loop;
}

}  // namespace cellocut
