// A scene put together from a model's nodes, meshes, camera and lights, whatever format they come from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/affine.h"
#include "convert/model/read_mesh.h"
#include "scene/description/scene_description.h"

namespace pprt {

// Whether scene files can hold a number. False for NaN.
bool is_in_range(double v);
bool is_in_range(const Vec3d& v);

// Where the contents of a file's node stand: in a node of the scene that moves, or in the world.
struct ModelSpace {
  NodeIndex node = 0;
  Affine map;
};

// A mesh in its node's space.
struct ModelMesh {
  std::vector<Vec3d> positions, normals;  // no normals: flat
  std::vector<Vec2d> texture_points;      // as TriangleMesh::texture_points; empty: none
  std::vector<std::uint32_t> corners;     // of all faces, one face after another
  std::vector<std::size_t> ends;          // of each face among the corners
};

// A camera in its node's space.
struct ModelCamera {
  std::string name;
  double half_height = 0;  // of the picture at a distance of 1
  double aspect = 1;       // width by height
  double near = 0;
  Vec3d from{0, 0, 0}, direction{0, 0, -1}, up{0, 1, 0};
};

class ModelBuilder {
 public:
  // `path`: of the model, for messages and as the scene's name.
  explicit ModelBuilder(const std::string& path) { scene_.name = path; }

  SceneDescription& scene() { return scene_; }
  std::vector<std::string>& notes() { return notes_; }

  // Throws InputError that names the model.
  [[noreturn]] void reject(const std::string& problem) const;

  // Counts points, lines or faces that are left out.
  void skip() { ++skipped_; }

  // Returns the name of the track of a node's name: "camera" is the view's own.
  static std::string track_name(const std::string& node);

  // Returns the space of a node. `own`: its transform where it does not move. `track`: its movement's name.
  ModelSpace space_of(const ModelSpace& parent, const Affine& own, const std::string& track);

  // Adds the faces of a mesh: triangles that share their corners where the material has a texture, otherwise
  // polygons. Rejects corners that are not there, and coordinates out of range.
  void add(const ModelMesh& mesh, const Material& material, const ModelSpace& space);

  // Takes the first usable camera as the view.
  void add(const ModelCamera& camera, const ModelSpace& space);

  // Adds a light, whose place is given in its node's space.
  void add(Light light, const ModelSpace& space);

  // Returns the scene, in which only that moves which has keys.
  ReadMesh finish(std::vector<std::string> files) &&;

 private:
  void note(std::size_t count, std::string_view one, std::string_view many);
  NodeIndex add_node(SceneNode node);
  std::vector<PatchVertex> vertices_of(const ModelMesh& mesh, const ModelSpace& space) const;
  void polygons(const ModelMesh& mesh, const std::vector<PatchVertex>& vertices, bool mirrored,
                MaterialIndex material);
  void polygon(MaterialIndex material);
  void textured_mesh(const ModelMesh& mesh, const std::vector<PatchVertex>& vertices, bool mirrored,
                     MaterialIndex material);
  void count_polygons(std::size_t more) const;
  void aim(View& view, const Affine& map) const;
  void move_camera();
  void drop_unused_tracks();

  SceneDescription scene_;
  std::vector<std::string> notes_;
  MaterialTable table_;
  std::size_t skipped_ = 0;
  std::size_t aimless_suns_ = 0;  // left out
  ModelCamera camera_;            // that the view is taken from
  ModelSpace camera_space_;
  std::vector<Vec3d> positions_;  // of the polygon at hand
  std::vector<PatchVertex> vertices_;
};

}  // namespace pprt
