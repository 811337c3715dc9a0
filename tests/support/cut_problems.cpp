#include "support/cut_problems.h"

#include <algorithm>
#include <limits>
#include <random>

namespace cellocut::testing {

namespace {

constexpr std::int64_t power_of_two(int exponent) { return std::int64_t{1} << exponent; }

CutLabels labels(const std::string& digits) {
  CutLabels result;
  for (const char digit : digits) result.push_back(digit == '1' ? 1 : 0);
  return result;
}

NamedProblem named(std::string name, CutProblem problem, std::int64_t value,
                   const std::string& smallest, const std::string& largest) {
  return {std::move(name), std::move(problem), {value, labels(smallest), labels(largest)}};
}

// 8 by 6 nodes, sources on the left, sinks on the right, a weak seam behind column 3.
NamedProblem grid_with_seam() {
  constexpr std::uint32_t kWidth = 8;
  constexpr std::uint32_t kHeight = 6;
  constexpr std::uint32_t kSeam = 3;
  CutProblem problem;
  problem.to_source.assign(kWidth * kHeight, 0);
  problem.to_sink.assign(kWidth * kHeight, 0);
  std::string source_side;
  for (std::uint32_t y = 0; y < kHeight; ++y) {
    problem.to_source[y * kWidth] = 100;
    problem.to_sink[y * kWidth + kWidth - 1] = 100;
    for (std::uint32_t x = 0; x < kWidth; ++x) {
      const std::uint32_t i = y * kWidth + x;
      if (x + 1 < kWidth) {
        const std::int64_t capacity = x == kSeam ? 2 : 10;
        problem.edges.push_back({i, i + 1, capacity, capacity});
      }
      if (y + 1 < kHeight) problem.edges.push_back({i, i + kWidth, 10, 10});
      source_side += x <= kSeam ? '1' : '0';
    }
  }
  return named("grid_with_seam", problem, 2 * kHeight, source_side, source_side);
}

std::vector<NamedProblem> make_known_problems() {
  std::vector<NamedProblem> list;
  list.push_back(named("empty", {}, 0, "", ""));
  list.push_back(named("constant_alone", {{}, {}, {}, 7}, 7, "", ""));
  list.push_back(named("single_node_passes_through", {{7}, {5}, {}, 0}, 5, "1", "1"));
  list.push_back(named("single_node_tie", {{4}, {4}, {}, 0}, 4, "0", "1"));
  list.push_back(named("single_node_without_terminals", {{0}, {0}, {}, 0}, 0, "0", "1"));
  list.push_back(named("only_sources", {{3, 0}, {0, 0}, {{0, 1, 2, 2}}, 0}, 0, "11", "11"));
  list.push_back(named("only_sinks", {{0, 0}, {0, 3}, {{0, 1, 2, 2}}, 0}, 0, "00", "00"));
  list.push_back(named("zero_capacity_edge", {{3, 0}, {0, 5}, {{0, 1, 0, 0}}, 0}, 0, "10", "10"));
  list.push_back(
      named("parallel_edges", {{10, 0}, {0, 10}, {{0, 1, 2, 0}, {0, 1, 3, 1}}, 0}, 5, "10", "10"));
  list.push_back(
      named("opposite_edges", {{10, 0}, {0, 10}, {{0, 1, 2, 0}, {1, 0, 4, 3}}, 0}, 5, "10", "10"));
  list.push_back(named("self_loops",
                       {{6, 0}, {0, 5}, {{0, 0, 9, 9}, {0, 1, 4, 0}, {1, 1, 0, 8}}, 0}, 4, "10",
                       "10"));
  // Three components: a chain cut at its sink, a node without capacities, a chain that is a tie.
  list.push_back(named("disconnected",
                       {{3, 0, 0, 4, 0}, {0, 2, 0, 0, 9}, {{0, 1, 5, 5}, {3, 4, 4, 4}}, 0}, 6,
                       "11000", "11110"));
  list.push_back(named("chain",
                       {{10, 0, 0, 0, 0},
                        {0, 0, 0, 0, 10},
                        {{0, 1, 9, 9}, {1, 2, 4, 4}, {2, 3, 8, 8}, {3, 4, 7, 7}},
                        0},
                       4, "11000", "11000"));
  list.push_back(named("chain_of_ties",
                       {{3, 0, 0, 0, 0},
                        {0, 0, 0, 0, 3},
                        {{0, 1, 3, 3}, {1, 2, 3, 3}, {2, 3, 3, 3}, {3, 4, 3, 3}},
                        0},
                       3, "00000", "11111"));
  // The cut is a tie between two edges of the chain, nothing else.
  list.push_back(named("tie_inside_a_chain",
                       {{9, 0, 0, 0}, {0, 0, 0, 9}, {{0, 1, 2, 2}, {1, 2, 5, 5}, {2, 3, 2, 2}}, 0},
                       2, "1000", "1110"));
  list.push_back(
      named("one_way_edge_against_the_flow", {{0, 7}, {7, 0}, {{0, 1, 5, 0}}, 0}, 0, "01", "01"));
  list.push_back(
      named("one_way_edge_given_backwards", {{0, 7}, {7, 0}, {{0, 1, 0, 5}}, 0}, 5, "01", "01"));
  // A first path 0-1-2-3 of unit flow has to be taken back across 1-2.
  list.push_back(named("flow_to_be_taken_back",
                       {{4, 0, 0, 0},
                        {0, 0, 0, 5},
                        {{0, 1, 2, 0}, {0, 2, 2, 0}, {1, 2, 2, 0}, {1, 3, 2, 0}, {2, 3, 2, 0}},
                        0},
                       4, "0000", "1110"));
  list.push_back(named("pass_through_and_constant", {{10, 6}, {3, 9}, {{0, 1, 2, 1}}, 1000}, 1011,
                       "10", "10"));
  list.push_back(grid_with_seam());
  list.push_back(named("single_node_near_2_61", {{power_of_two(61)}, {power_of_two(61) - 1}, {}, 0},
                       power_of_two(61) - 1, "1", "1"));
  list.push_back(named("edge_near_2_61",
                       {{power_of_two(59), 0},
                        {0, power_of_two(59)},
                        {{0, 1, power_of_two(61), power_of_two(60) - 1}},
                        0},
                       power_of_two(59), "00", "11"));
  list.push_back(named("constant_near_2_61",
                       {{power_of_two(60)}, {power_of_two(60) - 1}, {}, power_of_two(61)},
                       power_of_two(61) + power_of_two(60) - 1, "1", "1"));
  // Four sources meet in one node; all sums are just below 2^62.
  list.push_back(named("star_near_2_61",
                       {{power_of_two(59), power_of_two(59), power_of_two(59), power_of_two(59), 0},
                        {0, 0, 0, 0, power_of_two(60) - 1},
                        {{0, 4, power_of_two(58), 0},
                         {1, 4, power_of_two(58), 0},
                         {2, 4, power_of_two(58), 0},
                         {4, 3, 0, power_of_two(58)}},
                        0},
                       power_of_two(60) - 1, "11111", "11111"));
  return list;
}

// Uniform integers that are the same everywhere (standard distributions are not).
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  // In [0, bound).
  std::uint32_t below(std::uint32_t bound) { return static_cast<std::uint32_t>(engine_() % bound); }
  std::int64_t capacity(std::int64_t largest) {
    return static_cast<std::int64_t>(engine_() % static_cast<std::uint64_t>(largest + 1));
  }
  bool one_in(std::uint32_t n) { return below(n) == 0; }

 private:
  std::mt19937_64 engine_;
};

struct Recipe {
  std::int64_t largest_terminal = 100;
  std::int64_t largest_capacity = 100;
  std::uint32_t terminal_one_in = 3;  // a node in so many has that terminal
  bool one_way = false;
};

CutProblem nodes_with_terminals(std::uint32_t nodes, const Recipe& recipe, Random& random) {
  CutProblem problem;
  problem.to_source.assign(nodes, 0);
  problem.to_sink.assign(nodes, 0);
  for (std::uint32_t i = 0; i < nodes; ++i) {
    if (random.one_in(recipe.terminal_one_in)) {
      problem.to_source[i] = random.capacity(recipe.largest_terminal);
    }
    if (random.one_in(recipe.terminal_one_in)) {
      problem.to_sink[i] = random.capacity(recipe.largest_terminal);
    }
  }
  return problem;
}

void add_edge(CutProblem& problem, std::uint32_t from, std::uint32_t to, const Recipe& recipe,
              Random& random) {
  const std::int64_t forward = random.capacity(recipe.largest_capacity);
  const std::int64_t backward = recipe.one_way ? 0 : random.capacity(recipe.largest_capacity);
  problem.edges.push_back({from, to, forward, backward});
}

CutProblem random_edges(std::uint32_t nodes, std::uint32_t edges, const Recipe& recipe,
                        Random& random) {
  CutProblem problem = nodes_with_terminals(nodes, recipe, random);
  for (std::uint32_t e = 0; e < edges; ++e) {
    const std::uint32_t from = random.below(nodes);
    add_edge(problem, from, random.below(nodes), recipe, random);
  }
  return problem;
}

CutProblem grid_problem(std::uint32_t side, const Recipe& recipe, Random& random) {
  CutProblem problem = nodes_with_terminals(side * side * side, recipe, random);
  for (std::uint32_t i = 0; i < side * side * side; ++i) {
    if (i % side + 1 < side) add_edge(problem, i, i + 1, recipe, random);
    if (i / side % side + 1 < side) add_edge(problem, i, i + side, recipe, random);
    if (i / side / side + 1 < side) add_edge(problem, i, i + side * side, recipe, random);
  }
  return problem;
}

CutProblem path_problem(std::uint32_t nodes, const Recipe& recipe, Random& random) {
  CutProblem problem = nodes_with_terminals(nodes, recipe, random);
  for (std::uint32_t i = 0; i + 1 < nodes; ++i) add_edge(problem, i, i + 1, recipe, random);
  for (std::uint32_t k = 0; k < nodes / 10; ++k) {
    const std::uint32_t from = random.below(nodes);
    add_edge(problem, from, random.below(nodes), recipe, random);
  }
  return problem;
}

CutProblem bipartite_problem(std::uint32_t half, const Recipe& recipe, Random& random) {
  CutProblem problem;
  problem.to_source.assign(2 * std::size_t{half}, 0);
  problem.to_sink.assign(2 * std::size_t{half}, 0);
  for (std::uint32_t i = 0; i < half; ++i) {
    problem.to_source[i] = random.capacity(recipe.largest_terminal);
    problem.to_sink[half + i] = random.capacity(recipe.largest_terminal);
    for (std::uint32_t k = 0; k < 4; ++k) {
      add_edge(problem, i, half + random.below(half), recipe, random);
    }
  }
  return problem;
}

}  // namespace

const std::vector<NamedProblem>& known_problems() {
  static const std::vector<NamedProblem> list = make_known_problems();
  return list;
}

std::int64_t capacity_sum(const CutProblem& problem) {
  std::int64_t sum = problem.constant;
  for (std::size_t i = 0; i < problem.node_count(); ++i) {
    sum += problem.to_source[i] + problem.to_sink[i];
  }
  for (const CutEdge& edge : problem.edges) sum += edge.capacity + edge.reverse_capacity;
  return sum;
}

const std::vector<RandomShape>& random_shapes() {
  static const std::vector<RandomShape> shapes = {RandomShape::tiny,        RandomShape::sparse,
                                                  RandomShape::dense,       RandomShape::grid_3d,
                                                  RandomShape::long_path,   RandomShape::bipartite,
                                                  RandomShape::many_ties,   RandomShape::one_way,
                                                  RandomShape::tetrahedral, RandomShape::huge};
  return shapes;
}

const char* to_string(RandomShape shape) {
  switch (shape) {
    case RandomShape::tiny:
      return "tiny";
    case RandomShape::sparse:
      return "sparse";
    case RandomShape::dense:
      return "dense";
    case RandomShape::grid_3d:
      return "grid_3d";
    case RandomShape::long_path:
      return "long_path";
    case RandomShape::bipartite:
      return "bipartite";
    case RandomShape::many_ties:
      return "many_ties";
    case RandomShape::one_way:
      return "one_way";
    case RandomShape::tetrahedral:
      return "tetrahedral";
    case RandomShape::huge:
      return "huge";
  }
  return "unknown";
}

CutProblem random_problem(RandomShape shape, std::uint64_t seed) {
  Random random(1000 * static_cast<std::uint64_t>(shape) + seed);
  Recipe recipe;
  switch (shape) {
    case RandomShape::tiny: {
      recipe.largest_capacity = random.one_in(2) ? 4 : 50;
      recipe.largest_terminal = 2 * recipe.largest_capacity;
      const std::uint32_t nodes = 1 + random.below(12);
      CutProblem problem = random_edges(nodes, random.below(3 * nodes), recipe, random);
      problem.constant = random.capacity(20);
      return problem;
    }
    case RandomShape::sparse:
      recipe.terminal_one_in = 4 + random.below(20);
      recipe.largest_terminal = 300;
      return random_edges(300, 600, recipe, random);
    case RandomShape::dense:
      recipe.largest_terminal = 2000;
      return random_edges(60, 1500, recipe, random);
    case RandomShape::grid_3d:
      recipe.terminal_one_in = 2 + random.below(30);
      recipe.largest_terminal = 500;
      return grid_problem(8, recipe, random);
    case RandomShape::long_path:
      recipe.terminal_one_in = 50;
      recipe.largest_terminal = 1000;
      return path_problem(1500, recipe, random);
    case RandomShape::bipartite:
      return bipartite_problem(100, recipe, random);
    case RandomShape::many_ties:
      recipe.largest_capacity = 3;
      recipe.largest_terminal = 3;
      recipe.terminal_one_in = 2 + random.below(10);
      return random.one_in(2) ? grid_problem(6, recipe, random)
                              : random_edges(200, 500, recipe, random);
    case RandomShape::one_way:
      recipe.one_way = true;
      recipe.largest_terminal = 300;
      return random_edges(200, 800, recipe, random);
    case RandomShape::tetrahedral:
      return sheet_problem(9, seed);
    case RandomShape::huge: {
      constexpr std::uint32_t kNodes = 40;
      constexpr std::uint32_t kEdges = 100;
      recipe.largest_terminal = kCapacityLimit / (2 * kNodes + 2 * kEdges + 1);
      recipe.largest_capacity = recipe.largest_terminal;
      CutProblem problem = random_edges(kNodes, kEdges, recipe, random);
      // One source takes what is left below 2^62.
      problem.to_source[0] += kCapacityLimit - 1 - capacity_sum(problem);
      return problem;
    }
  }
  return {};
}

ExpectedCut exhaustive_cut(const CutProblem& problem) {
  const std::size_t nodes = problem.node_count();
  ExpectedCut best;
  best.value = std::numeric_limits<std::int64_t>::max();
  CutLabels side(nodes, 0);
  for (std::uint32_t mask = 0; mask < (1U << nodes); ++mask) {
    for (std::size_t i = 0; i < nodes; ++i) side[i] = (mask >> i) & 1U;
    const std::int64_t cost = cut_cost(problem, side);
    if (cost > best.value) continue;
    if (cost < best.value) {
      best = {cost, side, side};
      continue;
    }
    for (std::size_t i = 0; i < nodes; ++i) {
      best.smallest[i] &= side[i];
      best.largest[i] |= side[i];
    }
  }
  return best;
}

CutProblem sheet_problem(std::uint32_t side, std::uint64_t seed) {
  constexpr std::int64_t kLambda = 20;
  constexpr std::uint32_t kAnchored = std::numeric_limits<std::uint32_t>::max();
  Random random(seed);
  const auto area = [&random] { return 1 + random.capacity(random.one_in(8) ? 4000 : 400); };
  const std::uint32_t near = side / 4;
  const std::uint32_t far = side - 1 - near;

  // Cells of the sheet, the surface of a box with holes, are anchored and contracted into the
  // source.
  std::vector<std::uint32_t> node(std::size_t{side} * side * side);
  std::uint32_t nodes = 0;
  for (std::uint32_t i = 0; i < node.size(); ++i) {
    const std::uint32_t at[3] = {i % side, i / side % side, i / side / side};
    bool in_box = true;
    bool on_face = false;
    for (const std::uint32_t v : at) {
      in_box = in_box && v >= near && v <= far;
      on_face = on_face || v == near || v == far;
    }
    const bool hole = (at[0] / 3 + at[1] / 3 + at[2] / 3) % 5 == 0 && !random.one_in(10);
    node[i] = in_box && on_face && !hole ? kAnchored : nodes++;
  }

  CutProblem problem;
  problem.to_source.assign(nodes, 0);
  problem.to_sink.assign(nodes, 0);
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    if (a == kAnchored && b == kAnchored) return;
    if (a == kAnchored || b == kAnchored) {
      problem.to_source[a == kAnchored ? b : a] += area();
      return;
    }
    const std::int64_t capacity = kLambda * area();
    problem.edges.push_back({a, b, capacity, capacity});
  };
  for (std::uint32_t i = 0; i < node.size(); ++i) {
    const std::uint32_t x = i % side;
    const std::uint32_t y = i / side % side;
    const std::uint32_t z = i / side / side;
    // Four neighbours each: both along x, and one up and one down along y and z in turns.
    const bool even = (x + y + z) % 2 == 0;
    if (x + 1 < side) join(node[i], node[i + 1]);
    if (even && y + 1 < side) join(node[i], node[i + side]);
    if (!even && z + 1 < side) join(node[i], node[i + side * side]);
    for (const std::uint32_t v : {x, y, z}) {
      if (node[i] != kAnchored && (v == 0 || v + 1 == side)) {
        problem.to_sink[node[i]] += kLambda * area();
      }
    }
  }
  return problem;
}

CutProblem noisy_ball_problem(std::uint32_t side, std::uint64_t seed) {
  constexpr std::int64_t kNoise = 300;
  Random random(seed);
  Recipe recipe;
  recipe.largest_terminal = kNoise;
  recipe.terminal_one_in = 1;
  CutProblem problem = grid_problem(side, recipe, random);
  const auto centred = [side](std::uint32_t v) { return 2 * std::int64_t{v} - side; };
  for (std::uint32_t i = 0; i < problem.node_count(); ++i) {
    const std::int64_t x = centred(i % side);
    const std::int64_t y = centred(i / side % side);
    const std::int64_t z = centred(i / side / side);
    const bool inside = 2 * (x * x + y * y + z * z) < std::int64_t{side} * side;
    (inside ? problem.to_source : problem.to_sink)[i] += kNoise / 3;
  }
  return problem;
}

}  // namespace cellocut::testing
