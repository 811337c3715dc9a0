// The page of a report as a program without the 3D view writes it: REPORT.json OUT.html
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "tools/html_report.h"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    std::ifstream file(argv[1]);
    const auto report = nlohmann::ordered_json::parse(file);
    cellocut::tools::PageContent content;
    cellocut::TriangleSoup triangle;
    triangle.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    triangle.triangles = {{0, 1, 2}};
    content.scenes.push_back({"a triangle", {cellocut::tools::pack_mesh(triangle, 1)}});
    std::ofstream(argv[2]) << cellocut::tools::html_report(report, std::move(content));
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
