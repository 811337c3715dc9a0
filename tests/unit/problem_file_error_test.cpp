// What the readers say about files that hold no problem or no solution.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "problem_comparison.h"
#include "support/cut_problems.h"

namespace cellocut {
namespace {

std::string dimacs_error(const std::string& text) {
  return testing::input_error([&] { (void)parse_dimacs(text); });
}

std::string solution_error(const std::string& text) {
  return testing::input_error([&] { (void)parse_solution(text); });
}

const std::string kHead = "c head\np max 4 3\nn 1 s\nn 4 t\n";

TEST(DimacsErrors, Lines) {
  EXPECT_EQ(dimacs_error(kHead + "a 1 2 3\na 2 3 3\na 3 4 3\n"), "");
  EXPECT_EQ(dimacs_error(""), "line 1: the file ends before a problem line ('p max NODES ARCS')");
  EXPECT_EQ(dimacs_error("c x\n\n"),
            "line 2: the file ends before a problem line ('p max NODES ARCS')");
  EXPECT_EQ(dimacs_error("n 1 s\n"), "line 1: a node before the problem line ('p max NODES ARCS')");
  EXPECT_EQ(dimacs_error("\na 1 2 3\n"),
            "line 2: an arc before the problem line ('p max NODES ARCS')");
  EXPECT_EQ(dimacs_error("p max 4 3\n\n"),
            "line 2: the file ends before a source is named ('n ID s')");
  EXPECT_EQ(dimacs_error("p max 4 3\nn 1 s\n"),
            "line 2: the file ends before a sink is named ('n ID t')");
  EXPECT_EQ(dimacs_error("p max 4 3\nn 1 s\na 1 2 3\n"),
            "line 3: an arc before the sink ('n ID t') is named");
  EXPECT_EQ(dimacs_error("p max 4 3\nn 1 t\na 1 2 3\n"),
            "line 3: an arc before the source ('n ID s') is named");
  EXPECT_EQ(dimacs_error(kHead + "p max 4 3\n"),
            "line 5: a second problem line, the first is line 2");
  EXPECT_EQ(dimacs_error(kHead + "n 2 s\n"), "line 5: a second source, the first is 1");
  EXPECT_EQ(dimacs_error(kHead + "n 2 t\n"), "line 5: a second sink, the first is 4");
  EXPECT_EQ(dimacs_error("p max 4 3\nn 2 s\nn 2 t\n"), "line 3: node 2 is both source and sink");
  EXPECT_EQ(dimacs_error("p max 4 3\nn 2 x\n"),
            "line 2: expected 's' (source) or 't' (sink), found 'x'");
  EXPECT_EQ(dimacs_error(kHead + "f 1 2 3\n"),
            "line 5: expected a line of type c, p, n or a, found 'f'");
  EXPECT_EQ(dimacs_error("\x7F"
                         "ELF\1\n"),
            "line 1: expected a line of type c, p, n or a, found '?ELF?'");
  EXPECT_EQ(dimacs_error("p min 4 3\n"),
            "line 1: expected 'p max' (a maximum flow problem), found 'p' 'min'");
}

TEST(DimacsErrors, Counts) {
  EXPECT_EQ(dimacs_error("p max 1 0\n"),
            "line 1: a problem has 2 nodes at least, the source and the sink; this one has 1");
  EXPECT_EQ(dimacs_error("p max -4 0\n"), "line 1: the number of nodes is negative: -4");
  EXPECT_EQ(dimacs_error("p max 4 -1\n"), "line 1: the number of arcs is negative: -1");
  EXPECT_EQ(dimacs_error("p max 4\n"), "line 1: expected the number of arcs, the line ends");
  EXPECT_EQ(dimacs_error("p max 4 3 2\n"), "line 1: more fields than the format has: '2'");
  EXPECT_EQ(dimacs_error("p max 4000000000 0\nn 1 s\nn 2 t\n"),
            "line 1: 4000000000 nodes are too many for a file of 31 bytes");
  EXPECT_EQ(dimacs_error("p max 4294967296 0\n"),
            "line 1: 4294967296 nodes are too many for a file of 19 bytes");
  EXPECT_EQ(dimacs_error("p max 4 4294967296\n"), "line 1: 4294967296 arcs are more than 2^32 - 1");
  EXPECT_EQ(dimacs_error("p max 4 4000000000\nn 1 s\nn 4 t\na 1 2 3\n"),
            "line 4: the file ends after 1 arcs, line 1 announces 4000000000 (truncated)");
  EXPECT_EQ(dimacs_error(kHead + "a 1 2 3\na 2 3 3\n"),
            "line 6: the file ends after 2 arcs, line 2 announces 3 (truncated)");
  EXPECT_EQ(dimacs_error(kHead + "a 1 2 3\na 2 3 3\nc x\na 3 4 3\na 2 4 3\n"),
            "line 9: more arcs than the 3 that line 2 announces");
}

TEST(DimacsErrors, Fields) {
  EXPECT_EQ(dimacs_error(kHead + "a 1 2\n"), "line 5: expected a capacity, the line ends");
  EXPECT_EQ(dimacs_error(kHead + "a 1 2 3 4\n"), "line 5: more fields than the format has: '4'");
  EXPECT_EQ(dimacs_error("p max 4 3\nn 1 s t\n"), "line 2: more fields than the format has: 't'");
  EXPECT_EQ(dimacs_error(kHead + "a 1 2 -3\n"), "line 5: a capacity is negative: -3");
  EXPECT_EQ(dimacs_error(kHead + "a 2 1 -3\n"), "line 5: a capacity is negative: -3");
  EXPECT_EQ(dimacs_error(kHead + "a 1 2 1.5\n"),
            "line 5: expected a capacity, an integer, found '1.5'");
  EXPECT_EQ(dimacs_error(kHead + "a 1 2 inf\n"),
            "line 5: expected a capacity, an integer, found 'inf'");
  EXPECT_EQ(dimacs_error(kHead + "a 1 x 3\n"), "line 5: expected a node, an integer, found 'x'");
  EXPECT_EQ(dimacs_error(kHead + "a 0 2 3\n"),
            "line 5: node 0 is out of range, the nodes are 1 to 4");
  EXPECT_EQ(dimacs_error(kHead + "a 1 5 3\n"),
            "line 5: node 5 is out of range, the nodes are 1 to 4");
  EXPECT_EQ(dimacs_error(kHead + "a -1 2 3\n"),
            "line 5: node -1 is out of range, the nodes are 1 to 4");
  EXPECT_EQ(dimacs_error("p max 4 3\nn 5 s\n"),
            "line 2: node 5 is out of range, the nodes are 1 to 4");
  EXPECT_EQ(dimacs_error(kHead + "a 1 4294967298 3\n"),
            "line 5: node 4294967298 is out of range, the nodes are 1 to 4");
  EXPECT_EQ(dimacs_error(kHead + "a 1 2 9223372036854775808\n"),
            "line 5: a capacity does not fit 64 bits: '9223372036854775808'");
}

TEST(DimacsErrors, SumsAreRefusedWhereTheyGrowTooLarge) {
  const std::string message = "the capacities up to here sum to 2^62 or more and would overflow";
  EXPECT_EQ(dimacs_error(kHead + "a 1 2 4611686018427387903\na 2 3 0\na 3 4 0\n"), "");
  EXPECT_EQ(dimacs_error(kHead + "a 1 2 4611686018427387904\n"), "line 5: " + message);
  EXPECT_EQ(dimacs_error(kHead + "a 1 2 4611686018427387903\na 3 4 1\n"), "line 6: " + message);
  // Parallel arcs, whose sum alone would overflow 64 bits.
  EXPECT_EQ(dimacs_error(kHead + "a 2 3 9223372036854775807\na 3 2 9223372036854775807\n"),
            "line 5: " + message);
  EXPECT_EQ(dimacs_error(kHead + "a 1 4 4000000000000000000\na 1 4 4000000000000000000\n"),
            "line 6: " + message);
}

TEST(SolutionErrors, Lines) {
  EXPECT_EQ(solution_error("s 4\nf 1 2 4\n"), "");
  EXPECT_EQ(solution_error("f 1 2 4\n"),
            "line 1: the file ends without a solution line ('s VALUE')");
  EXPECT_EQ(solution_error("s 4\r\ns 4\r\n"),
            "line 2: a second solution line, the first is line 1");
  EXPECT_EQ(solution_error("s -4\n"), "line 1: the value of the flow is negative: -4");
  EXPECT_EQ(solution_error("s\n"), "line 1: expected the value of the flow, the line ends");
  EXPECT_EQ(solution_error("s 4 4\n"), "line 1: more fields than the format has: '4'");
  EXPECT_EQ(solution_error("s 4\nf 1 2\n"), "line 2: expected a flow, the line ends");
  EXPECT_EQ(solution_error("s 4\nf 1 2 -1\n"), "line 2: a flow is negative: -1");
  EXPECT_EQ(solution_error("s 4\na 0 2 1\n"), "line 2: node 0 is out of range");
  EXPECT_EQ(solution_error("s 4\na 1 4294967296 1\n"), "line 2: node 4294967296 is out of range");
  EXPECT_EQ(solution_error("s 4\nf 1 2 0.5\n"), "line 2: expected a flow, an integer, found '0.5'");
  EXPECT_EQ(solution_error("s 4\nn 1 s\n"),
            "line 2: expected a line of type c, s, f or a, found 'n'");
}

// Cut off anywhere or with bytes overwritten, a file is read or refused with a place, nothing else.
TEST(DimacsErrors, DamagedFiles) {
  const std::string whole = encode_dimacs(testing::random_problem(testing::RandomShape::tiny, 5));
  const std::size_t last_line = whole.rfind('\n', whole.size() - 2) + 1;
  for (std::size_t size = 0; size < last_line; ++size) {
    EXPECT_THAT(dimacs_error(whole.substr(0, size)), ::testing::StartsWith("line "))
        << "cut to " << size << " bytes";
  }
  std::mt19937_64 random(1);
  const std::string bytes = "0123456789-acnpst \n\r\xFF";
  int refused = 0;
  constexpr int kRounds = 3000;
  for (int round = 0; round < kRounds; ++round) {
    std::string damaged = whole;
    for (int k = 0; k < 3; ++k) damaged[random() % damaged.size()] = bytes[random() % bytes.size()];
    const std::string message = dimacs_error(damaged);
    if (!message.empty()) {
      ++refused;
      EXPECT_THAT(message, ::testing::StartsWith("line ")) << damaged;
    }
  }
  EXPECT_GT(refused, kRounds / 4);
  EXPECT_LT(refused, kRounds);
}

}  // namespace
}  // namespace cellocut
