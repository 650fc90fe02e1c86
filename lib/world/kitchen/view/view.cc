#include "world/kitchen/view/view.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "world/kitchen/geometry/palette.h"
#include "world/kitchen/view/hit_colour.h"

namespace synpo {
namespace {

constexpr int kHeadings = 4, kHorizons = 3;

// Solids with the objects of a frame put among them.
class Furnished {
 public:
  Furnished(const KitchenSolids& solids, const KitchenFrame& frame) : cell_(ray_cell(frame.eye.row, frame.eye.column)) {
    std::memcpy(reach_, solids.reach.data(), size_t(solids.cells) * sizeof(float));
    std::memset(occupants_, kNoObject, size_t(solids.cells));
    for (size_t i = 0; i < kKitchenObjects; ++i) {
      if (frame.objects[i] < 0) continue;
      const size_t cell = size_t(frame.objects[i]);
      occupants_[cell] = uint8_t(i);
      reach_[cell] = std::max(reach_[cell], solids.columns[cell].top + kObjectReach);
    }
    view_ = {&solids, float(frame.eye.column) + 0.5f, float(frame.eye.row) + 0.5f, reach_, occupants_};
  }
  Furnished(const Furnished&) = delete;
  const SolidsView& view() const { return view_; }
  int cell() const { return cell_; }  // of the eye

 private:
  float reach_[kRayCells];
  uint8_t occupants_[kRayCells];
  SolidsView view_;
  int cell_;
};

// Directions of a picture's rays; their part along the camera's axis is 1.
class Lens {
 public:
  Lens(const KitchenPose& pose, int width, int height)
      : camera_(pose.heading / 90, pose.horizon), width_(width), height_(height) {}
  Vec3 direction(int row, int column) const {
    const float u = across(column, width_), v = -across(row, height_);
    const Vec3 &f = camera_.forward, &r = camera_.right, &a = camera_.up;
    return {f.x + u * r.x + v * a.x, f.y + u * r.y + v * a.y, f.z + u * r.z + v * a.z};
  }
  static float length(const Vec3& d) { return std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z); }

 private:
  static float across(int pixel, int pixels) { return kViewSlope * ((2 * float(pixel) + 1) / float(pixels) - 1); }
  Camera camera_;
  int width_, height_;
};

void store(const Colour& colour, uint8_t* rgb) {
  const auto byte = [](float value) { return uint8_t(value + 0.5f); };
  rgb[0] = byte(colour.r);
  rgb[1] = byte(colour.g);
  rgb[2] = byte(colour.b);
}

// The ways of the rays of a small view. The eye always stands in the middle of a cell, so that from every cell they are
// the same.
class StoredRays {
 public:
  struct Step {
    float lowest;    // of the ray in this cell; below everything where floor or ceiling ends it
    int16_t offset;  // from the eye's cell
    Face entered;
  };
  struct Ray {
    Vec3 direction;
    float length;
    uint32_t first;  // in steps() and t_out()
  };

  static const StoredRays& of(const KitchenPose& pose) {
    static const std::array<StoredRays, kHeadings* kHorizons> all = make();
    return all[size_t(pose.heading / 90 * kHorizons + pose.horizon / 30 + 1)];
  }
  const std::vector<Ray>& rays() const { return rays_; }
  const Step* steps() const { return steps_.data(); }
  const float* t_out() const { return t_out_.data(); }

 private:
  static std::array<StoredRays, kHeadings * kHorizons> make() {
    std::array<StoredRays, kHeadings * kHorizons> all;
    for (int heading = 0; heading < kHeadings; ++heading)
      for (int horizon = 0; horizon < kHorizons; ++horizon)
        all[size_t(heading * kHorizons + horizon)].fill({0, 0, int16_t(heading * 90), int16_t(horizon * 30 - 30)});
    return all;
  }
  void fill(const KitchenPose& pose) {
    const Lens lens(pose, kSmallView, kSmallView);
    for (int row = 0; row < kSmallView; ++row)
      for (int column = 0; column < kSmallView; ++column) {
        const Vec3 direction = lens.direction(row, column);
        rays_.push_back({direction, Lens::length(direction), uint32_t(steps_.size())});
        // Walls end a ray that neither floor nor ceiling does: no way within them is longer.
        RayWalk walk(0, direction);
        for (int i = 0; i < 2 * kMaxKitchenSide; ++i, walk.next()) {
          const float low = lowest(direction.z, walk.t_in, walk.t_out);
          const bool ends = low < 0 || kEyeHeight + direction.z * walk.t_out >= kRoomHeight;
          steps_.push_back({ends ? -std::numeric_limits<float>::infinity() : low, int16_t(walk.cell), walk.face});
          t_out_.push_back(walk.t_out);
          if (ends) break;
        }
      }
  }
  std::vector<Ray> rays_;
  std::vector<Step> steps_;
  std::vector<float> t_out_;
};

}  // namespace

void render(const KitchenSolids& solids, const KitchenFrame& frame, int width, int height, uint8_t* rgb) {
  const Furnished room(solids, frame);
  const Lens lens(frame.eye, width, height);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column, rgb += 3) {
      const Vec3 direction = lens.direction(row, column);
      const Hit hit = trace(room.view(), room.cell(), direction);
      store(colour_of_hit(room.view(), frame.doors, hit, direction, Lens::length(direction)), rgb);
    }
}

void render_small(const KitchenSolids& solids, const KitchenFrame& frame, uint8_t* rgb) {
  const Furnished room(solids, frame);
  const StoredRays& stored = StoredRays::of(frame.eye);
  const float* reach = room.view().reach + room.cell();
  for (const StoredRays::Ray& ray : stored.rays()) {
    const StoredRays::Step* const first = stored.steps() + ray.first;
    const float* const t_out = stored.t_out() + ray.first;
    Hit hit;
    for (const StoredRays::Step* step = first;; ++step) {
      while (step->lowest >= reach[step->offset]) ++step;
      const size_t i = size_t(step - first);
      if (hit_in_cell(room.view(), ray.direction, room.cell() + step->offset, i ? t_out[i - 1] : 0, t_out[i],
                      step->entered, hit))
        break;
    }
    store(colour_of_hit(room.view(), frame.doors, hit, ray.direction, ray.length), rgb);
    rgb += 3;
  }
}

}  // namespace synpo
