#include <algorithm>
#include <limits>
#include <optional>

#include "cellocut/base/errors.h"
#include "cellocut/cut/arc_merger.h"
#include "cellocut/cut/file_limits.h"
#include "cellocut/cut/problem_file.h"
#include "cellocut/cut/text_lines.h"

namespace cellocut {

namespace {

using cut_io::TextLines;

// The shortest arc line is `a 1 2 3` and its end.
constexpr std::size_t kShortestArc = 8;

class DimacsReader {
 public:
  explicit DimacsReader(std::string_view text) : size_(text.size()), lines_(text) {}

  DimacsProblem read() {
    while (lines_.next()) {
      const std::string_view kind = lines_.token();
      if (kind == "a") {
        read_arc();
      } else if (kind == "n") {
        read_node();
      } else if (kind == "p") {
        read_problem();
      } else {
        lines_.fail("expected a line of type c, p, n or a, found " + quoted(kind));
      }
    }
    return finish();
  }

 private:
  void read_problem() {
    if (problem_line_ != 0) {
      lines_.fail("a second problem line, the first is line " + std::to_string(problem_line_));
    }
    problem_line_ = lines_.number();
    const std::string_view type = lines_.token();
    if (type != "max") {
      lines_.fail("expected 'p max' (a maximum flow problem), found 'p' " + quoted(type));
    }
    const auto ids = static_cast<std::uint64_t>(lines_.count("the number of nodes"));
    announced_ = static_cast<std::uint64_t>(lines_.count("the number of arcs"));
    lines_.expect_end();
    if (ids < 2) {
      lines_.fail("a problem has 2 nodes at least, the source and the sink; this one has " +
                  std::to_string(ids));
    }
    if (ids > cut_io::kMostIds || !cut_io::plausible_node_count(ids, size_)) {
      lines_.fail(std::to_string(ids) + " nodes are too many for a file of " +
                  std::to_string(size_) + " bytes");
    }
    if (announced_ > std::numeric_limits<std::uint32_t>::max()) {
      lines_.fail(std::to_string(announced_) + " arcs are more than 2^32 - 1");
    }
    ids_ = static_cast<std::uint32_t>(ids);
    result_.problem.to_source.assign(ids_ - 2, 0);
    result_.problem.to_sink.assign(ids_ - 2, 0);
    arcs_.reserve(std::min<std::size_t>(announced_, size_ / kShortestArc));
  }

  void read_node() {
    if (problem_line_ == 0) lines_.fail("a node before the problem line ('p max NODES ARCS')");
    const std::uint32_t id = read_id();
    const std::string_view which = lines_.token();
    if (which != "s" && which != "t") {
      lines_.fail("expected 's' (source) or 't' (sink), found " + quoted(which));
    }
    lines_.expect_end();
    const bool is_source = which == "s";
    std::optional<std::uint32_t>& named = is_source ? source_ : sink_;
    const std::optional<std::uint32_t>& other = is_source ? sink_ : source_;
    if (named) {
      lines_.fail(std::string("a second ") + (is_source ? "source" : "sink") + ", the first is " +
                  std::to_string(*named));
    }
    if (other == id) lines_.fail("node " + std::to_string(id) + " is both source and sink");
    named = id;
    if (source_ && sink_) result_.nodes = {*source_, *sink_};
  }

  void read_arc() {
    if (problem_line_ == 0) lines_.fail("an arc before the problem line ('p max NODES ARCS')");
    if (!source_ || !sink_) {
      lines_.fail(std::string("an arc before the ") +
                  (source_ ? "sink ('n ID t')" : "source ('n ID s')") + " is named");
    }
    if (arcs_read_ == announced_) {
      lines_.fail("more arcs than the " + std::to_string(announced_) + " that line " +
                  std::to_string(problem_line_) + " announces");
    }
    const std::uint32_t from = read_id();
    const std::uint32_t to = read_id();
    const std::int64_t capacity = lines_.count("a capacity");
    lines_.expect_end();
    ++arcs_read_;
    add_arc(from, to, capacity);
  }

  std::uint32_t read_id() {
    const std::int64_t id = lines_.integer("a node");
    if (id < 1 || id > std::int64_t{ids_}) {
      lines_.fail("node " + std::to_string(id) + " is out of range, the nodes are 1 to " +
                  std::to_string(ids_));
    }
    return static_cast<std::uint32_t>(id);
  }

  void add_arc(std::uint32_t from, std::uint32_t to, std::int64_t capacity) {
    const auto [source, sink] = result_.nodes;
    if (from == to || to == source || from == sink) {
      result_.left_out.push_back({from, to, capacity});
      return;
    }
    if (!sum_.add(capacity)) lines_.fail(cut_io::kSumTooLarge);
    CutProblem& problem = result_.problem;
    if (from == source && to == sink) {
      problem.constant += capacity;
    } else if (from == source) {
      problem.to_source[result_.nodes.node(to)] += capacity;
    } else if (to == sink) {
      problem.to_sink[result_.nodes.node(from)] += capacity;
    } else {
      arcs_.push_back({result_.nodes.node(from), result_.nodes.node(to), capacity});
    }
  }

  DimacsProblem finish() {
    if (problem_line_ == 0) lines_.fail("the file ends before a problem line ('p max NODES ARCS')");
    if (!source_) lines_.fail("the file ends before a source is named ('n ID s')");
    if (!sink_) lines_.fail("the file ends before a sink is named ('n ID t')");
    if (arcs_read_ != announced_) {
      lines_.fail("the file ends after " + std::to_string(arcs_read_) + " arcs, line " +
                  std::to_string(problem_line_) + " announces " + std::to_string(announced_) +
                  " (truncated)");
    }
    result_.problem.edges = cut_io::merge_arcs(arcs_, result_.problem.node_count());
    result_.problem.validate();
    return std::move(result_);
  }

  std::size_t size_;
  TextLines lines_;
  std::size_t problem_line_ = 0;  // 0 until there was one
  std::uint32_t ids_ = 0;
  std::uint64_t announced_ = 0;
  std::uint64_t arcs_read_ = 0;
  std::optional<std::uint32_t> source_;
  std::optional<std::uint32_t> sink_;
  std::vector<cut_io::Arc> arcs_;  // between nodes that are neither source nor sink
  cut_io::CapacitySum sum_;
  DimacsProblem result_;
};

}  // namespace

DimacsProblem parse_dimacs(std::string_view text) { return DimacsReader(text).read(); }

}  // namespace cellocut
