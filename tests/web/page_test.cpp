// The pieces of the page of a comparison, without a browser.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "tools/html_parts.h"
#include "tools/html_report.h"

namespace cellocut::tools {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::ordered_json;

TEST(HtmlParts, EscapesWhatHasAMeaning) {
  EXPECT_EQ(escape_html("a<b> & \"c\" 'd'"), "a&lt;b&gt; &amp; &quot;c&quot; &#39;d&#39;");
}

TEST(HtmlParts, Base64OfTheStandard) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe"), "//4=");
}

TEST(HtmlParts, GroupsOfThreeDigits) {
  EXPECT_EQ(group_digits(999), "999");
  EXPECT_EQ(group_digits(-1000), "-1\u202f000");
  EXPECT_EQ(group_digits(1234567), "1\u202f234\u202f567");
}

TEST(HtmlParts, BarsBeginAtZeroAndEndAtTheLongest) {
  const std::string chart =
      bar_chart("t", "", {{"a", {{"x", "x", 5}}, "5"}, {"b", {{"x", "x", 10}}, "10"}}, true);
  EXPECT_THAT(chart, HasSubstr("width:50.000%"));
  EXPECT_THAT(chart, HasSubstr("width:100.000%"));
  EXPECT_THAT(bar_chart("t", "", {{"a", {{"x", "x", -1}}, ""}}, true), HasSubstr("width:0.000%"));
}

// Faces that share no point, in a row.
TriangleSoup lone_triangles(std::uint32_t count) {
  TriangleSoup soup;
  soup.points.reserve(3 * std::size_t{count});
  soup.triangles.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const double x = i;
    soup.points.insert(soup.points.end(), {{x, 0, 0}, {x + 0.5, 0, 0}, {x, 0.5, 0}});
    soup.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return soup;
}

TEST(PackedMesh, KeepsAMeshThatIsSmallEnough) {
  const PackedMesh mesh = pack_mesh(lone_triangles(4), 4);
  EXPECT_EQ(mesh.triangles.size(), 4U);
  EXPECT_EQ(mesh.positions.size(), 12U);
  EXPECT_EQ(mesh.size, 3.5);
  EXPECT_EQ(mesh.positions[mesh.triangles[0][0]], (std::array<std::uint16_t, 3>{0, 0, 0}));
}

TEST(PackedMesh, NeverHasMoreFacesThanAllowedNotEvenOfASoup) {
  const PackedMesh mesh = pack_mesh(lone_triangles(1000), 100);
  EXPECT_LE(mesh.triangles.size(), 100U);
  EXPECT_EQ(mesh.faces_before, 1000U);
}

TEST(PackedMesh, LeavesOutWhatCannotBeDrawn) {
  TriangleSoup soup = lone_triangles(2);
  soup.points[5][1] = std::numeric_limits<double>::quiet_NaN();
  soup.triangles.push_back({0, 0, 1});
  EXPECT_EQ(pack_mesh(soup, 10).triangles.size(), 1U);
  EXPECT_TRUE(pack_mesh(TriangleSoup{}, 10).triangles.empty());
}

Json small_report() {
  const Json times{{"minimum", 0.5}, {"median", 0.75}, {"maximum", 1.0}, {"all", {0.5, 1.0}}};
  const Json run{{"solver", "bk"},
                 {"status", "optimal"},
                 {"value", 1234567},
                 {"lower_bound", 1234567},
                 {"gap", 0},
                 {"stop", ""},
                 {"build_seconds", times},
                 {"solve_seconds", times},
                 {"verify_seconds", times},
                 {"bytes", 0}};
  const Json refused{{"solver", "clp"}, {"status", "refused"}, {"message", "too <large>"}};
  Json report{{"version", "1"}, {"repeats", 2}, {"parameters", {{"resolution", 16}}}};
  report["instances"] = Json::array({{{"input", "dir/a<b>.max"},
                                      {"backend", ""},
                                      {"statistics", {{"nodes", 4}, {"edges", 3}}},
                                      {"energy_unit", 0.0},
                                      {"runs", {run, refused}},
                                      {"stages", Json::array()},
                                      {"defect", ""}}});
  report["backends"] = Json::array();
  return report;
}

TEST(HtmlReport, HasTheNumbersAndNoForeignMarkup) {
  const std::string page = html_report(small_report(), {});
  EXPECT_THAT(page, HasSubstr("data-key=\"value\" data-value=\"1234567\""));
  EXPECT_THAT(page, HasSubstr("data-key=\"solve_seconds\" data-value=\"0.75\""));
  EXPECT_THAT(page, HasSubstr("a&lt;b&gt;.max"));
  EXPECT_THAT(page, Not(HasSubstr("a<b>")));
  EXPECT_THAT(page, HasSubstr("too &lt;large&gt;"));
  EXPECT_THAT(page, Not(HasSubstr("no-viewer")));  // there is nothing to show in 3D
}

TEST(HtmlReport, ClaimsNoProofWhereAGapIsLeft) {
  Json report = small_report();
  EXPECT_THAT(html_report(report, {}), HasSubstr("every result is proved"));
  EXPECT_THAT(html_report(report, {}), HasSubstr("Refused: 1."));
  report["instances"][0]["runs"][0]["gap"] = 5;
  EXPECT_THAT(html_report(report, {}), HasSubstr("0 of 1 results are proved"));
  report["instances"][0]["defect"] = "bk is <wrong>";
  EXPECT_THAT(html_report(report, {}), HasSubstr("bk is &lt;wrong&gt;"));
  EXPECT_THAT(html_report(report, {}), Not(HasSubstr("solvers agree")));
}

TEST(HtmlReport, SaysWhyThereIsNo3DView) {
  PageContent content;
  content.scenes.push_back({"m", {pack_mesh(lone_triangles(3), 3)}});
  EXPECT_THAT(html_report(small_report(), content),
              HasSubstr("this program was built without it (this is a test)"));
}

TEST(HtmlReport, LeavesOutPicturesWhereThePageWouldBeTooLargeAndSaysSo) {
  PageContent content;
  content.pictures.push_back({0, "picture one", "image/png", std::string(10'000, 'x')});
  content.pictures.push_back({0, "picture two", "image/png", std::string(60'000, 'x')});
  const std::string page = html_report(small_report(), content, 60'000);
  EXPECT_LT(page.size(), 60'000U);
  EXPECT_THAT(page, HasSubstr("picture one"));
  EXPECT_THAT(page, Not(HasSubstr("picture two")));
  EXPECT_THAT(page, HasSubstr("the page stays below 0.1 MB"));
}

}  // namespace
}  // namespace cellocut::tools
