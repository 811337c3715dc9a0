// The binary format of the max-flow benchmark collection.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <random>

#include "problem_comparison.h"
#include "support/cut_problems.h"

namespace cellocut {
namespace {

using testing::expect_same_cuts;
using testing::expect_same_problem;
using testing::expect_same_terminals;

// Bytes put together by hand, lowest first.
class Bytes {
 public:
  Bytes& text(const std::string& value) {
    bytes_ += value;
    return *this;
  }
  Bytes& u8(std::uint8_t value) { return number(value, 1); }
  Bytes& i32(std::int32_t value) { return number(static_cast<std::uint32_t>(value), 4); }
  Bytes& i64(std::int64_t value) { return number(static_cast<std::uint64_t>(value), 8); }
  Bytes& u64(std::uint64_t value) { return number(value, 8); }
  Bytes& f64(double value) { return number(std::bit_cast<std::uint64_t>(value), 8); }
  Bytes& head(std::uint8_t edge_type, std::uint8_t terminal_type, std::uint64_t nodes,
              std::uint64_t terminals, std::uint64_t edges) {
    return text("BBQ").u8(edge_type).u8(terminal_type).u64(nodes).u64(terminals).u64(edges);
  }
  [[nodiscard]] const std::string& str() const { return bytes_; }

 private:
  Bytes& number(std::uint64_t value, int size) {
    for (int k = 0; k < size; ++k) bytes_ += static_cast<char>((value >> (8 * k)) & 0xFFU);
    return *this;
  }
  std::string bytes_;
};

std::string bbk_error(const std::string& bytes) {
  return testing::input_error([&] { (void)parse_bbk(bytes); });
}

const CutProblem& example() {
  static const CutProblem problem{{7, 0, 0}, {0, 0, 300}, {{0, 1, 4, 2}, {2, 1, 0, 70000}}, 0};
  return problem;
}

TEST(Bbk, WhatIsWritten) {
  const std::string int32 = Bytes()
                                .head(5, 5, 3, 2, 2)
                                .u64(0)
                                .i32(7)
                                .i32(0)
                                .u64(2)
                                .i32(0)
                                .i32(300)
                                .u64(0)
                                .u64(1)
                                .i32(4)
                                .i32(2)
                                .u64(2)
                                .u64(1)
                                .i32(0)
                                .i32(70000)
                                .str();
  const std::string int64 = Bytes()
                                .head(7, 7, 3, 2, 2)
                                .u64(0)
                                .i64(7)
                                .i64(0)
                                .u64(2)
                                .i64(0)
                                .i64(300)
                                .u64(0)
                                .u64(1)
                                .i64(4)
                                .i64(2)
                                .u64(2)
                                .u64(1)
                                .i64(0)
                                .i64(70000)
                                .str();
  EXPECT_EQ(encode_bbk(example(), BbkCapacity::int32), int32);
  EXPECT_EQ(encode_bbk(example()), int64);
  expect_same_problem(parse_bbk(int32), example());
  expect_same_problem(parse_bbk(int64), example());
}

TEST(Bbk, TypesMayDifferAndTerminalRecordsAddUp) {
  const std::string bytes = Bytes()
                                .head(5, 9, 3, 3, 2)
                                .u64(0)
                                .f64(3)
                                .f64(0)
                                .u64(2)
                                .f64(0)
                                .f64(0x1p53)
                                .u64(0)
                                .f64(4)
                                .f64(5)
                                .u64(0)
                                .u64(1)
                                .i32(4)
                                .i32(2)
                                .u64(1)
                                .u64(1)
                                .i32(8)
                                .i32(9)
                                .str();
  expect_same_problem(parse_bbk(bytes),
                      {{7, 0, 0}, {5, 0, std::int64_t{1} << 53}, {{0, 1, 4, 2}, {1, 1, 8, 9}}, 0});
  const std::string other =
      Bytes().head(9, 7, 2, 1, 1).u64(1).i64(1).i64(2).u64(0).u64(1).f64(6).f64(-0.0).str();
  expect_same_problem(parse_bbk(other), {{0, 1}, {0, 2}, {{0, 1, 6, 0}}, 0});
}

TEST(Bbk, RoundTrips) {
  for (const testing::RandomShape shape : testing::random_shapes()) {
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      SCOPED_TRACE(std::string(to_string(shape)) + ' ' + std::to_string(seed));
      CutProblem problem = testing::random_problem(shape, seed);
      const std::int64_t constant = problem.constant;
      problem.constant = 0;
      std::erase_if(problem.edges, [](const CutEdge& edge) { return edge.from == edge.to; });
      expect_same_problem(parse_bbk(encode_bbk(problem)), problem);
      if (shape != testing::RandomShape::huge) {
        expect_same_problem(parse_bbk(encode_bbk(problem, BbkCapacity::int32)), problem);
      }
      problem.constant = constant + 1;
      if (shape == testing::RandomShape::huge) continue;  // no room for it twice
      const CutProblem moved = parse_bbk(encode_bbk(problem));
      EXPECT_EQ(moved.constant, 0);
      EXPECT_EQ(moved.to_source[0], problem.to_source[0] + problem.constant);
      EXPECT_EQ(moved.to_sink[0], problem.to_sink[0] + problem.constant);
      expect_same_cuts(moved, problem);
    }
  }
}

TEST(Bbk, LoopsAreNotWritten) {
  const CutProblem problem{{6, 0}, {0, 5}, {{0, 0, 9, 9}, {0, 1, 4, 0}, {1, 1, 0, 8}}, 0};
  expect_same_problem(parse_bbk(encode_bbk(problem)), {{6, 0}, {0, 5}, {{0, 1, 4, 0}}, 0});
}

TEST(Bbk, AConstantWithoutNodesGetsOne) {
  const CutProblem read = parse_bbk(encode_bbk({{}, {}, {}, 12}));
  expect_same_terminals(read, {{12}, {12}, {}, 0});
  EXPECT_EQ(testing::solved(read).value, 12);
  expect_same_terminals(parse_bbk(encode_bbk({})), {});
}

TEST(Bbk, WhatDoesNotFitIsRefused) {
  constexpr std::int64_t kTooLarge = std::int64_t{1} << 31;
  const auto as_int32 = [](const CutProblem& problem) {
    return encode_bbk(problem, BbkCapacity::int32);
  };
  EXPECT_NO_THROW((void)as_int32({{kTooLarge - 1}, {0}, {}, 0}));
  EXPECT_THROW((void)as_int32({{kTooLarge}, {0}, {}, 0}), LimitError);
  EXPECT_THROW((void)as_int32({{0}, {kTooLarge}, {}, 0}), LimitError);
  EXPECT_THROW((void)as_int32({{kTooLarge - 1}, {0}, {}, 1}), LimitError);
  EXPECT_THROW((void)as_int32({{0, 0}, {0, 0}, {{0, 1, kTooLarge, 0}}, 0}), LimitError);
  EXPECT_THROW((void)as_int32({{0, 0}, {0, 0}, {{0, 1, 0, kTooLarge}}, 0}), LimitError);
  // Valid as it is, not with its constant counted twice.
  EXPECT_THROW((void)encode_bbk({{1}, {0}, {}, kCapacityLimit / 2}), LimitError);
  EXPECT_NO_THROW((void)encode_bbk({{1}, {0}, {}, kCapacityLimit / 2 - 1}));
}

TEST(BbkErrors, Header) {
  EXPECT_EQ(bbk_error(""), "byte 0: not a bbk file: it does not begin with 'BBQ'");
  EXPECT_EQ(bbk_error("BBX5"), "byte 0: not a bbk file: it does not begin with 'BBQ'");
  EXPECT_THAT(bbk_error("bbq\5\5"), ::testing::StartsWith("byte 0: a compressed file ('bbq')"));
  EXPECT_EQ(bbk_error("BBQ\5\5"), "the header has 29 bytes, the file has 5 (truncated)");
  EXPECT_EQ(bbk_error(Bytes().head(8, 5, 0, 0, 0).str()),
            "byte 3: capacity type 8, only int32 (5), int64 (7) and double (9) are read");
  EXPECT_EQ(bbk_error(Bytes().head(5, 255, 0, 0, 0).str()),
            "byte 4: capacity type 255, only int32 (5), int64 (7) and double (9) are read");
  EXPECT_EQ(bbk_error(Bytes().head(5, 7, 4, std::uint64_t{1} << 60, 0).u64(0).str()),
            "the header promises 1152921504606846976 terminal records of 24 bytes, the file has 8 "
            "bytes left for them (truncated)");
  EXPECT_EQ(bbk_error(Bytes().head(5, 7, 4, 0, std::numeric_limits<std::uint64_t>::max()).str()),
            "the header promises 18446744073709551615 edge records of 24 bytes, the file has 0 "
            "bytes left for them (truncated)");
  EXPECT_EQ(bbk_error(Bytes().head(5, 5, 1, 0, 0).u8(0).u8(0).str()),
            "byte 29: 2 bytes after the last record that the header promises");
  EXPECT_EQ(bbk_error(Bytes().head(5, 5, std::uint64_t{1} << 32, 0, 0).str()),
            "byte 5: 4294967296 nodes are too many for a file of 29 bytes");
  EXPECT_EQ(bbk_error(Bytes().head(5, 5, 2000000000, 0, 0).str()),
            "byte 5: 2000000000 nodes are too many for a file of 29 bytes");
}

TEST(BbkErrors, Records) {
  const auto terminals = [] { return Bytes().head(7, 7, 2, 2, 0).u64(0).i64(1).i64(2); };
  EXPECT_EQ(bbk_error(terminals().u64(1).i64(3).i64(4).str()), "");
  EXPECT_EQ(bbk_error(terminals().u64(2).i64(3).i64(4).str()),
            "terminal record 2 of 2: node 2 is out of range, there are 2, counted from 0");
  EXPECT_EQ(bbk_error(terminals().u64(1).i64(3).i64(-4).str()),
            "terminal record 2 of 2: the capacity is negative: -4");
  EXPECT_EQ(bbk_error(terminals().u64(1).i64(kCapacityLimit - 3).i64(0).str()),
            "terminal record 2 of 2: the capacities up to here sum to 2^62 or more and would "
            "overflow");
  const auto edge = [] { return Bytes().head(5, 5, 2, 0, 1); };
  EXPECT_EQ(bbk_error(edge().u64(0).u64(1).i32(3).i32(4).str()), "");
  EXPECT_EQ(bbk_error(edge().u64(0).u64(std::uint64_t{1} << 32).i32(3).i32(4).str()),
            "edge record 1 of 1: node 4294967296 is out of range, there are 2, counted from 0");
  EXPECT_EQ(bbk_error(edge().u64(0).u64(1).i32(-3).i32(4).str()),
            "edge record 1 of 1: the capacity is negative: -3");
  const auto real = [](double capacity) {
    return bbk_error(Bytes().head(9, 5, 2, 0, 1).u64(0).u64(1).f64(4).f64(capacity).str());
  };
  EXPECT_EQ(real(0x1p61), "");
  EXPECT_EQ(real(0.5),
            "edge record 1 of 1: the capacity 0.500000 is not an integer; scale the capacities to "
            "integers first");
  EXPECT_THAT(real(1e30), ::testing::HasSubstr("does not fit 64 bits"));
  EXPECT_THAT(real(std::numeric_limits<double>::quiet_NaN()),
              ::testing::HasSubstr("does not fit 64 bits"));
  EXPECT_THAT(real(-std::numeric_limits<double>::infinity()),
              ::testing::HasSubstr("does not fit 64 bits"));
  EXPECT_THAT(real(-1), ::testing::HasSubstr("is negative: -1"));
  EXPECT_THAT(real(0x1p62), ::testing::HasSubstr("sum to 2^62 or more"));
}

TEST(BbkErrors, DamagedFiles) {
  const std::string whole = encode_bbk(testing::random_problem(testing::RandomShape::tiny, 5));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_NE(bbk_error(whole.substr(0, size)), "") << "cut to " << size << " bytes";
  }
  std::mt19937_64 random(1);
  int refused = 0;
  constexpr int kRounds = 3000;
  for (int round = 0; round < kRounds; ++round) {
    std::string damaged = whole;
    damaged[random() % damaged.size()] = static_cast<char>(random());
    if (!bbk_error(damaged).empty()) ++refused;
  }
  EXPECT_GT(refused, kRounds / 4);
  EXPECT_LT(refused, kRounds);
}

}  // namespace
}  // namespace cellocut
