// The contents of an AFF scene as plain values: NFF's objects, meshes, textures, and what moves.
//
// Nothing is transformed: each object stands in the space of its node. Coordinates are right-handed.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/affine.h"
#include "base/source_location.h"
#include "base/vector.h"
#include "scene/motion_track.h"
#include "scene/scene_description.h"

namespace pprt {

// AFF "fm": a colour for each term. NFF's "f" gives colour * Kd, and a grey Ks.
struct SurfaceMaterial {
  Rgb ambient{0, 0, 0};  // times the scene's ambient light
  Rgb diffuse{1, 1, 1};
  Rgb specular{0, 0, 0};  // highlight, and weight of the mirrored ray
  double shine = 0;       // Phong exponent
  double transmittance = 0;
  double refractive_index = 1;  // above 0

  friend bool operator==(const SurfaceMaterial&, const SurfaceMaterial&) = default;
};

using NodeIndex = std::uint32_t;     // into MovingScene::nodes
using TextureIndex = std::uint32_t;  // into MovingScene::textures

// A coordinate system in that of its parent. Node 0 is the world.
struct SceneNode {
  NodeIndex parent = 0;
  Affine to_parent;   // where it does not move
  std::string track;  // the name of its movement; empty: none
  SourceLocation location = {};
};

// What every object has.
struct ObjectPlace {
  MaterialIndex material = 0;
  NodeIndex node = 0;
  SourceLocation location = {};
};

// Indices of the corners of a mesh's triangle.
struct MeshTriangle {
  std::array<std::uint32_t, 3> position{}, normal{}, texture_point{};
};

// Front faces run counter-clockwise, but files are careless: opaque ones are shown from both sides.
struct Mesh {
  std::vector<Vec3d> positions;
  std::vector<Vec3d> normals;  // empty: flat; as given, of any length
  std::vector<Vec2d>
      texture_points;  // empty: no texture. (0, 0) is the picture's upper left corner, (1, 1) the lower right
  std::vector<MeshTriangle> triangles;
  std::optional<TextureIndex> texture = {};
  ObjectPlace place = {};
};

// AFF "tpa": a triangle whose corners move. Between keys positions and normals change evenly.
struct MovingTriangle {
  struct Key {
    double time = 0;
    std::array<Vec3d, 3> positions, normals;
  };
  std::vector<Key> keys;  // ascending, at least one
  ObjectPlace place = {};
};

struct MovingLight {
  Light light = {};
  NodeIndex node = 0;
  std::string track = {};  // gives its place in its node's space; empty: it stands still
};

// Frames at equal distances in time.
struct FrameTimes {
  double start = 0, end = 0;  // seconds, of the first and the last frame
  int frames = 1;
};

// Invariant: indices are in range, and a node's parent comes before it.
struct MovingScene {
  std::string name;
  Rgb background{0, 0, 0};
  Rgb ambient{1, 1, 1};
  std::optional<View> view = {};
  std::vector<MovingLight> lights = {};
  std::vector<SurfaceMaterial> materials = {};  // distinct
  std::vector<std::string> textures = {};       // names as written, distinct
  std::vector<SceneNode> nodes = {{}};
  std::map<std::string, MotionTrack, std::less<>> tracks = {};
  std::vector<Mesh> meshes = {};
  std::vector<MovingTriangle> moving_triangles = {};
  std::vector<std::pair<Sphere, NodeIndex>> spheres = {};
  std::vector<std::pair<Cone, NodeIndex>> cones = {};
  std::optional<FrameTimes> times = {};
};

// Returns the time of a frame, from 0, in seconds.
double time_of_frame(const FrameTimes& times, int frame);

// Returns where every node stands in the world, and whether it is shown, at a time.
std::vector<Placement> placements_at(const MovingScene& scene, double time);

// Returns the view at a time: the track "camera" moves it. Empty where the scene has no view.
std::optional<View> view_at(const MovingScene& scene, double time);

// Returns the triangle at a time; normals are of unit length where they are not zero.
MovingTriangle::Key shape_at(const MovingTriangle& triangle, double time);

// The track that moves the camera.
inline constexpr const char* kCameraTrack = "camera";

}  // namespace pprt
