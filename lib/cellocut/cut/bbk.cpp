#include <algorithm>
#include <limits>
#include <type_traits>

#include "cellocut/base/byte_order.h"
#include "cellocut/base/errors.h"
#include "cellocut/cut/file_limits.h"
#include "cellocut/cut/problem_file.h"

namespace cellocut {

namespace {

constexpr std::string_view kMagic = "BBQ";
constexpr std::string_view kCompressedMagic = "bbq";
constexpr std::size_t kHeaderSize = kMagic.size() + 2 + 3 * sizeof(std::uint64_t);
constexpr std::uint8_t kInt32 = 5;
constexpr std::uint8_t kInt64 = 7;
constexpr std::uint8_t kDouble = 9;

std::size_t size_of(std::uint8_t type, std::size_t offset) {
  if (type == kInt32) return sizeof(std::int32_t);
  if (type == kInt64) return sizeof(std::int64_t);
  if (type == kDouble) return sizeof(double);
  throw InputError("byte " + std::to_string(offset) + ": capacity type " + std::to_string(type) +
                   ", only int32 (5), int64 (7) and double (9) are read");
}

// One of the two lists of records: two 64-bit or one 64-bit numbers, then two capacities.
class Records {
 public:
  Records(std::string_view bytes, const char* kind, std::uint64_t count, std::size_t numbers,
          std::uint8_t type, std::uint64_t nodes, cut_io::CapacitySum& sum)
      : bytes_(bytes),
        kind_(kind),
        count_(count),
        numbers_(numbers),
        type_(type),
        nodes_(nodes),
        sum_(sum) {}

  void go_to(std::uint64_t record) {
    record_ = record;
    at_ = bytes_.data() + record * (bytes_.size() / count_);
  }

  std::uint32_t node(std::size_t which) const {
    const auto node = load_little_endian<std::uint64_t>(at_ + which * sizeof(std::uint64_t));
    if (node >= nodes_) {
      fail("node " + std::to_string(node) + " is out of range, there are " +
           std::to_string(nodes_) + ", counted from 0");
    }
    return static_cast<std::uint32_t>(node);
  }

  std::int64_t capacity(std::size_t which) {
    const char* first = at_ + numbers_ * sizeof(std::uint64_t);
    std::int64_t value = 0;
    if (type_ == kInt32) {
      value = load_little_endian<std::int32_t>(first + which * sizeof(std::int32_t));
    } else if (type_ == kInt64) {
      value = load_little_endian<std::int64_t>(first + which * sizeof(std::int64_t));
    } else {
      value = integer(load_little_endian<double>(first + which * sizeof(double)));
    }
    if (value < 0) fail("the capacity is negative: " + std::to_string(value));
    if (!sum_.add(value)) fail(cut_io::kSumTooLarge);
    return value;
  }

 private:
  std::int64_t integer(double value) const {
    constexpr double kTooLarge = 0x1p63;
    if (!(value > -kTooLarge && value < kTooLarge)) {
      fail("the capacity " + std::to_string(value) + " does not fit 64 bits");
    }
    const auto rounded = static_cast<std::int64_t>(value);
    if (static_cast<double>(rounded) != value) {
      fail("the capacity " + std::to_string(value) +
           " is not an integer; scale the capacities to integers first");
    }
    return rounded;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(std::string(kind_) + " record " + std::to_string(record_ + 1) + " of " +
                     std::to_string(count_) + ": " + what);
  }

  std::string_view bytes_;
  const char* kind_;
  std::uint64_t count_;
  std::size_t numbers_;
  std::uint8_t type_;
  std::uint64_t nodes_;
  cut_io::CapacitySum& sum_;
  std::uint64_t record_ = 0;
  const char* at_ = nullptr;
};

struct Header {
  std::uint8_t edge_type = 0;
  std::uint8_t terminal_type = 0;
  std::uint64_t nodes = 0;
  std::uint64_t terminals = 0;
  std::uint64_t edges = 0;
  std::size_t terminal_bytes = 0;  // all records together
  std::size_t edge_bytes = 0;
};

// `count` records of `size` bytes out of `left`, which is made less.
std::size_t take(std::uint64_t count, std::size_t size, std::size_t& left, const char* kind) {
  if (count > left / size) {
    throw InputError("the header promises " + std::to_string(count) + " " + kind + " records of " +
                     std::to_string(size) + " bytes, the file has " + std::to_string(left) +
                     " bytes left for them (truncated)");
  }
  left -= count * size;
  return count * size;
}

Header read_header(std::string_view bytes) {
  const std::string_view magic = bytes.substr(0, kMagic.size());
  if (magic == kCompressedMagic) {
    throw InputError(
        "byte 0: a compressed file ('bbq'), only uncompressed ones ('BBQ') are read; the "
        "collection's bench_io converts");
  }
  if (magic != kMagic) throw InputError("byte 0: not a bbk file: it does not begin with 'BBQ'");
  if (bytes.size() < kHeaderSize) {
    throw InputError("the header has " + std::to_string(kHeaderSize) + " bytes, the file has " +
                     std::to_string(bytes.size()) + " (truncated)");
  }
  Header header;
  const char* at = bytes.data() + kMagic.size();
  header.edge_type = load_little_endian<std::uint8_t>(at);
  header.terminal_type = load_little_endian<std::uint8_t>(at + 1);
  const std::size_t edge_capacity = size_of(header.edge_type, kMagic.size());
  const std::size_t terminal_capacity = size_of(header.terminal_type, kMagic.size() + 1);
  at += 2;
  header.nodes = load_little_endian<std::uint64_t>(at);
  header.terminals = load_little_endian<std::uint64_t>(at + sizeof(std::uint64_t));
  header.edges = load_little_endian<std::uint64_t>(at + 2 * sizeof(std::uint64_t));

  std::size_t left = bytes.size() - kHeaderSize;
  header.terminal_bytes =
      take(header.terminals, sizeof(std::uint64_t) + 2 * terminal_capacity, left, "terminal");
  header.edge_bytes =
      take(header.edges, 2 * sizeof(std::uint64_t) + 2 * edge_capacity, left, "edge");
  if (left != 0) {
    throw InputError("byte " + std::to_string(bytes.size() - left) + ": " + std::to_string(left) +
                     " bytes after the last record that the header promises");
  }
  if (header.nodes > cut_io::kMostNodes ||
      !cut_io::plausible_node_count(header.nodes, bytes.size())) {
    throw InputError("byte " + std::to_string(kMagic.size() + 2) + ": " +
                     std::to_string(header.nodes) + " nodes are too many for a file of " +
                     std::to_string(bytes.size()) + " bytes");
  }
  return header;
}

// The sum that the problem has once its constant stands on a node must be read back.
void require_room_for_constant(const CutProblem& problem) {
  if (problem.constant == 0) return;
  cut_io::CapacitySum sum;
  bool fits = sum.add(problem.constant) && sum.add(problem.constant);
  for (std::size_t i = 0; i < problem.node_count(); ++i) {
    fits = fits && sum.add(problem.to_source[i]) && sum.add(problem.to_sink[i]);
  }
  for (const CutEdge& edge : problem.edges) {
    fits = fits && sum.add(edge.capacity) && sum.add(edge.reverse_capacity);
  }
  if (!fits) {
    throw LimitError(
        "bbk: the constant has to be written twice, and with it the capacities sum to 2^62 or "
        "more");
  }
}

template <class Capacity>
Capacity fitted(std::int64_t value) {
  if (value > std::numeric_limits<Capacity>::max()) {
    throw LimitError("bbk: the capacity " + std::to_string(value) +
                     " does not fit int32; write int64");
  }
  return static_cast<Capacity>(value);
}

template <class Capacity>
std::string encode(const CutProblem& problem, BbkCapacity type) {
  const auto constant_at = [&problem](std::size_t i) { return i == 0 ? problem.constant : 0; };
  std::size_t nodes = problem.node_count();
  std::string terminals;
  std::uint64_t terminal_count = 0;
  const auto add_terminal = [&](std::size_t i, std::int64_t source, std::int64_t sink) {
    if (source == 0 && sink == 0) return;
    append_little_endian<std::uint64_t>(terminals, i);
    append_little_endian(terminals, fitted<Capacity>(source));
    append_little_endian(terminals, fitted<Capacity>(sink));
    ++terminal_count;
  };
  for (std::size_t i = 0; i < nodes; ++i) {
    add_terminal(i, problem.to_source[i] + constant_at(i), problem.to_sink[i] + constant_at(i));
  }
  if (nodes == 0 && problem.constant > 0) {
    add_terminal(nodes++, problem.constant, problem.constant);
  }
  const auto is_loop = [](const CutEdge& edge) { return edge.from == edge.to; };
  const auto loops = std::count_if(problem.edges.begin(), problem.edges.end(), is_loop);

  std::string bytes(kMagic);
  append_little_endian(bytes, static_cast<std::uint8_t>(type));
  append_little_endian(bytes, static_cast<std::uint8_t>(type));
  append_little_endian<std::uint64_t>(bytes, nodes);
  append_little_endian<std::uint64_t>(bytes, terminal_count);
  append_little_endian<std::uint64_t>(bytes,
                                      problem.edges.size() - static_cast<std::size_t>(loops));
  bytes.reserve(bytes.size() + terminals.size() +
                problem.edges.size() * 2 * (sizeof(std::uint64_t) + sizeof(Capacity)));
  bytes += terminals;
  for (const CutEdge& edge : problem.edges) {
    if (is_loop(edge)) continue;
    append_little_endian<std::uint64_t>(bytes, edge.from);
    append_little_endian<std::uint64_t>(bytes, edge.to);
    append_little_endian(bytes, fitted<Capacity>(edge.capacity));
    append_little_endian(bytes, fitted<Capacity>(edge.reverse_capacity));
  }
  return bytes;
}

}  // namespace

CutProblem parse_bbk(std::string_view bytes) {
  const Header header = read_header(bytes);
  cut_io::CapacitySum sum;
  CutProblem problem;
  problem.to_source.assign(header.nodes, 0);
  problem.to_sink.assign(header.nodes, 0);
  Records terminals(bytes.substr(kHeaderSize, header.terminal_bytes), "terminal", header.terminals,
                    1, header.terminal_type, header.nodes, sum);
  for (std::uint64_t r = 0; r < header.terminals; ++r) {
    terminals.go_to(r);
    const std::uint32_t node = terminals.node(0);
    problem.to_source[node] += terminals.capacity(0);
    problem.to_sink[node] += terminals.capacity(1);
  }
  Records edges(bytes.substr(kHeaderSize + header.terminal_bytes, header.edge_bytes), "edge",
                header.edges, 2, header.edge_type, header.nodes, sum);
  problem.edges.reserve(header.edges);
  for (std::uint64_t r = 0; r < header.edges; ++r) {
    edges.go_to(r);
    const std::uint32_t from = edges.node(0);
    const std::uint32_t to = edges.node(1);
    const std::int64_t capacity = edges.capacity(0);
    problem.edges.push_back({from, to, capacity, edges.capacity(1)});
  }
  problem.validate();
  return problem;
}

std::string encode_bbk(const CutProblem& problem, BbkCapacity type) {
  require_room_for_constant(problem);
  return type == BbkCapacity::int32 ? encode<std::int32_t>(problem, type)
                                    : encode<std::int64_t>(problem, type);
}

}  // namespace cellocut
