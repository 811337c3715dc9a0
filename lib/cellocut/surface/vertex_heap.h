// A priority queue of vertices whose keys may change.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace cellocut {

// A heap with four children to a node (fewer cache misses than two). The vertex with the smallest
// key comes first, the lower one where keys are equal: the order of the calls does not matter.
class VertexHeap {
 public:
  explicit VertexHeap(std::size_t vertices) : place_(vertices, kOutside) {}

  [[nodiscard]] bool empty() const { return entries_.empty(); }
  [[nodiscard]] double least_key() const { return entries_.front().key; }

  // Puts the vertex in, or moves it to its new key. O(log n).
  void set(std::uint32_t vertex, double key) {
    if (place_[vertex] == kOutside) {
      place_[vertex] = static_cast<std::uint32_t>(entries_.size());
      entries_.push_back({key, vertex});
    }
    settle(place_[vertex], {key, vertex});
  }

  // Takes the vertex out if it is in. O(log n).
  void remove(std::uint32_t vertex) {
    const std::uint32_t place = place_[vertex];
    if (place == kOutside) return;
    place_[vertex] = kOutside;
    const Entry last = entries_.back();
    entries_.pop_back();
    if (last.vertex != vertex) settle(place, last);
  }

  // The first vertex and its key; it is out then. O(log n). Precondition: not empty.
  std::pair<std::uint32_t, double> pop() {
    const Entry first = entries_.front();
    remove(first.vertex);
    return {first.vertex, first.key};
  }

 private:
  static constexpr std::uint32_t kOutside = 0xFFFFFFFFU;

  struct Entry {
    double key;
    std::uint32_t vertex;
    bool operator<(const Entry& other) const {
      return key < other.key || (key == other.key && vertex < other.vertex);
    }
  };

  void put(std::size_t place, const Entry& entry) {
    entries_[place] = entry;
    place_[entry.vertex] = static_cast<std::uint32_t>(place);
  }

  // Puts the entry where it belongs on the way from `place` up or down.
  void settle(std::size_t place, const Entry& entry) {
    while (place > 0 && entry < entries_[(place - 1) / 4]) {
      put(place, entries_[(place - 1) / 4]);
      place = (place - 1) / 4;
    }
    for (;;) {
      std::size_t least = 4 * place + 1;
      if (least >= entries_.size()) break;
      for (std::size_t child = least + 1; child < entries_.size() && child <= 4 * place + 4;
           ++child) {
        if (entries_[child] < entries_[least]) least = child;
      }
      if (!(entries_[least] < entry)) break;
      put(place, entries_[least]);
      place = least;
    }
    put(place, entry);
  }

  std::vector<Entry> entries_;
  std::vector<std::uint32_t> place_;  // by vertex
};

}  // namespace cellocut
