// SPDX-License-Identifier: Apache-2.0
// Lines over pictures, and the edges of models that they show.
#include "scene/solve/observations.h"

#include <gtest/gtest.h>

#include "scene/camera.h"
#include "test_scene.h"

namespace chromeball::picture_lines_test {
namespace {

// The sum over pixels of a white line on black is its length times its width.
double drawn(const glm::dvec2& from, const glm::dvec2& to) {
  Image image(200, 160, 3);
  PictureLines(image).line(from, to, Rgb(1));
  double sum = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) sum += image.rgb(x, y).x;
  return sum;
}

TEST(PictureLines, CoverTheirArea) {
  constexpr double kWidth = 1.2;  // of a picture this small
  for (const glm::dvec2 to : {glm::dvec2(120, 40), {40, 130}, {120, 133}, {121.3, 40.2}})
    EXPECT_NEAR(drawn({40, 40}, to), kWidth * glm::distance(glm::dvec2(40, 40), to), 4);
  // Lines of any length are clipped at the border, and nothing is drawn outside.
  EXPECT_NEAR(drawn({-1e9, 80}, {1e9, 80}), 200 * kWidth, 1);
  EXPECT_EQ(drawn({-50, -60}, {-5, 400}), 0);
  EXPECT_EQ(drawn({300, 10}, {900, 10}), 0);
  EXPECT_NEAR(drawn({50, 50}, {50, 50}), kWidth * kWidth, 1);
}

TEST(PictureLines, CreasesAreBordersAndSharpEdges) {
  Scene scene;
  const int grey = addMaterial(scene, lambert(Rgb(0.5f)));
  addQuad(scene, grey, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  EXPECT_EQ(creases(scene).size(), 4u);  // not the diagonal
  Scene ball;
  addSphere(ball, addMaterial(ball, lambert(Rgb(0.5f))), vec3(0), 1, 16);
  EXPECT_EQ(creases(ball).size(), 0u);
  // The six faces of a box as one mesh: its twelve edges.
  Mesh box;
  for (int i = 0; i < 8; ++i) box.positions.emplace_back(i & 1, (i >> 1) & 1, i >> 2);
  box.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  Scene boxes;
  addMesh(boxes, addMaterial(boxes, lambert(Rgb(0.5f))), box);
  EXPECT_EQ(creases(boxes).size(), 12u);
}

// An edge that goes behind the camera is drawn up to the border, and a distorted one is curved.
TEST(PictureLines, EdgesFollowTheLens) {
  Camera camera;
  camera.fov = 1;
  Image behind(200, 160, 3);
  const std::vector<ModelEdge> rail{{{0, -1, -10}, {0, -1, 10}}};
  drawEdges(rail, camera, Rgb(1), behind);
  EXPECT_GT(behind.rgb(100, 155).x, 0.5f);
  EXPECT_EQ(behind.rgb(100, 70).x, 0);

  camera.distortion = {-0.3, 0};
  const glm::dvec3 middle(0, 0.4, -1), side(0.45, 0.4, -1);
  const CameraView view(camera, 200.0 / 160);
  Image curved(200, 160, 3);
  const std::vector<ModelEdge> bar{{{-0.5f, 0.4f, -1}, {0.5f, 0.4f, -1}}};
  drawEdges(bar, camera, Rgb(1), curved);
  double bend = 0;
  for (const glm::dvec3& point : {middle, side}) {
    const glm::dvec2 at = glm::dvec2(200, 160) * view.at(point)->position;
    EXPECT_GT(curved.rgb(int(at.x), int(at.y)).x, 0.3f);
    bend = at.y - bend;
  }
  EXPECT_GT(bend, 2);
}

}  // namespace
}  // namespace chromeball::picture_lines_test
