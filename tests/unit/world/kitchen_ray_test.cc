#include "world/kitchen/geometry/ray.h"

#include <gtest/gtest.h>

#include "helpers/kitchens.h"
#include "world/kitchen/kitchen_set.h"

namespace synpo {
namespace {

TEST(KitchenRay, MeetsThingsWhereTheyStand) {
  const KitchenSolids solids(small_kitchen());
  const SolidsView view = {&solids, 4.5f, 4.5f, solids.reach.data(), nullptr};
  const auto expect = [&](Vec3 direction, Material material, Face face, float t) {
    const Hit hit = trace(view, ray_cell(4, 4), direction);
    EXPECT_EQ(int(hit.material), int(material));
    EXPECT_EQ(int(hit.face), int(face));
    EXPECT_NEAR(hit.t, t, 1e-5);
  };
  expect({0, -1, 0}, Material::kWall, Face::kSouth, 3.5f);
  expect({1, 0, 0}, Material::kWall, Face::kWest, 4.5f);
  expect({-1, 0, 0}, Material::kWall, Face::kEast, 3.5f);
  expect({0, -1, -1}, Material::kCounterTop, Face::kTop, 2.4f);
  expect({0, -1, -2}, Material::kCabinet, Face::kSouth, 1.5f);
  expect({0, -1, -5}, Material::kFloor, Face::kTop, 1.2f);
  expect({0, -1, 4}, Material::kCeiling, Face::kBottom, 1);
  expect({-1.5f, -1.5f, 0}, Material::kFridge, Face::kSouth, 1);
  expect({0, 1, -4}, Material::kTable, Face::kTop, 0.75f);
  expect({0, 1, -6.2f}, Material::kTable, Face::kNorth, 0.5f);
  expect({0.1f, 1, -7.5f}, Material::kFloor, Face::kTop, 0.8f);  // between its legs
  expect({1.5f, -2.5f, -3}, Material::kSink, Face::kTop, 3.04f / 3);
  expect({2, -1.57f, -2.4f}, Material::kSink, Face::kTop, 1);             // its rim
  expect({-1.4f, 0.6f, -5}, Material::kTable, Face::kEast, 1.3f / 1.4f);  // a leg
  expect({0, 4.5f, -2}, Material::kMicrowave, Face::kNorth, 3.62f / 4.5f);
}

}  // namespace
}  // namespace synpo
