#include "trace/compiled_scene.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <utility>

#include "base/diagnostics.h"
#include "scene/shading_rules.h"
#include "scene/view_frame.h"
#include "trace/numerics.h"
#include "trace/repeats.h"
#include "trace/scene_impl.h"

namespace pprt {
namespace {

Color to_color(const Rgb& rgb) {
  return Color(rgb);
}

bool finite(const Vec3d& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

[[noreturn]] void reject(const std::string& name, SourceLocation at, const std::string& problem) {
  const std::string place =
      at.line > 0 ? name + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) : name;
  throw InputError(place + ": error: " + problem);
}

// Returns the origin of the compiled space, about which floats are finest. Usually it is the middle of the
// scene's box.
//
// If nearly all of the scene is empty or one large object, floats are coarse for the rest. The origin is then
// the mean of the objects' middles, weighted by 1 / size^2. Test: hard_surfaces_test.cpp, "a huge sphere
// ...".
Vec3d origin_for(const SceneDescription& scene, const Box3d& box) {
  constexpr double kSmallDetail = 0x1p-14;  // share of the scene's size
  constexpr double kNoExtent = 1e-12;       // of the scene's size; smaller ones would take all the weight
  const double whole = (box.max - box.min).length();
  double weights = 0, objects = 0;
  Vec3d sum(0, 0, 0);  // of the objects' middles, relative to the box's middle
  const Vec3d middle = box.min * 0.5 + box.max * 0.5;
  for (const PrimitiveRef ref : scene.order) {
    const Box3d own = bounds(scene, ref);
    const double size = (own.max - own.min).length() / whole;
    if (!(size > kNoExtent)) continue;
    ++objects;
    weights += 1 / (size * size);
    sum += (own.min * 0.5 + own.max * 0.5 - middle) * (1 / (size * size));
  }
  const double typical = std::sqrt(objects / weights);
  return typical < kSmallDetail ? middle + sum * (1 / weights) : middle;
}

// Returns the radius of the sphere about the origin that contains the normalised box.
double radius_about_origin(const Normalisation& map, const Box3d& box) {
  const Vec3d low = map.point(box.min), high = map.point(box.max);
  const auto farther = [](double a, double b) { return std::max(std::abs(a), std::abs(b)); };
  return Vec3d(farther(low.x, high.x), farther(low.y, high.y), farther(low.z, high.z)).length();
}

ShadingMaterial shading_material(const Material& m, double ambient_weight) {
  ShadingMaterial result;
  result.ambient = to_color(m.color * (kAmbientReflectance * ambient_weight));
  result.diffuse = to_color(m.color * m.diffuse);
  result.specular = static_cast<float>(m.specular);
  result.shine = has_highlight(m) ? static_cast<float>(m.shine) : 0;
  result.transmittance = static_cast<float>(m.transmittance);
  result.refractive_index = effective_refractive_index(m);
  result.lit = result.diffuse != Color(0, 0, 0) || result.shine > 0;
  return result;
}

// Sorts the primitives into parts: those of one kind with the same visible faces.
class PartsBuilder {
 public:
  PartsBuilder(const SceneDescription& scene, CompiledScene::Impl& impl) : scene_(scene), impl_(impl) {}

  void run() {
    repeats_ = find_repeats(scene_);
    impl_.figures.repeated = repeats_.count;
    impl_.figures.first_repeated = repeats_.first;
    add_all(PrimitiveKind::kSphere, scene_.spheres);
    add_all(PrimitiveKind::kCone, scene_.cones);
    add_all(PrimitiveKind::kPolygon, scene_.polygons);
    add_all(PrimitiveKind::kPatch, scene_.patches);
  }

 private:
  template <class Primitive>
  void add_all(PrimitiveKind kind, const std::vector<Primitive>& primitives) {
    for (std::size_t i = 0; i < scene_.order.size(); ++i) {
      if (scene_.order[i].kind != kind || (repeats_.count > 0 && repeats_.repeated[i])) continue;
      primitive_ = static_cast<std::uint32_t>(i);
      add(primitives[scene_.order[i].index]);
    }
  }

  VisibleFaces faces(MaterialIndex material, bool inside_only) const {
    if (inside_only) return VisibleFaces::kBack;
    const bool opaque = !(scene_.materials[material].transmittance > 0);
    return impl_.options.cull && opaque ? VisibleFaces::kFront : VisibleFaces::kBoth;
  }

  // Linear search: a kind has at most three parts.
  template <class Shape>
  std::pair<ScenePart&, Shape&> part(PrimitiveKind kind, VisibleFaces faces) {
    for (ScenePart& p : impl_.parts) {
      if (p.kind == kind && p.faces == faces) return {p, std::get<Shape>(p.shape)};
    }
    impl_.parts.push_back({kind, faces, Shape(), {}, {}});
    return {impl_.parts.back(), std::get<Shape>(impl_.parts.back().shape)};
  }

  void add(const Sphere& s) {
    require(finite(s.center) && std::isfinite(s.radius), s.location);
    if (s.radius == 0) return drop();
    auto [to, shape] =
        part<std::vector<SphereRecord>>(PrimitiveKind::kSphere, faces(s.material, s.radius < 0));
    shape.push_back({impl_.normalisation.point(s.center), impl_.normalisation.length(std::abs(s.radius))});
    finish(to, 1, s.material);
  }

  void add(const Cone& c) {
    require(finite(c.base) && finite(c.apex) && std::isfinite(c.base_radius + c.apex_radius), c.location);
    const double base_radius = impl_.normalisation.length(std::abs(c.base_radius));
    const double apex_radius = impl_.normalisation.length(std::abs(c.apex_radius));
    const Vec3d axis = (c.apex - c.base) * impl_.normalisation.scale;
    if (axis.dot(axis) == 0 || (base_radius == 0 && apex_radius == 0)) return drop();
    const bool inside_only = c.base_radius < 0 || c.apex_radius < 0;
    auto [to, shape] = part<std::vector<ConeRecord>>(PrimitiveKind::kCone, faces(c.material, inside_only));
    shape.push_back({impl_.normalisation.point(c.base), axis, base_radius, apex_radius - base_radius});
    finish(to, 1, c.material);
  }

  void add(const Polygon& p) {
    positions_.clear();
    for (const Vec3d& v : scene_.vertices(p)) {
      require(finite(v), p.location);
      positions_.push_back(impl_.normalisation.point(v));
    }
    auto [to, mesh] = part<Mesh>(PrimitiveKind::kPolygon, faces(p.material, false));
    finish_mesh(to, mesh.add(positions_, {}), p.material);
  }

  void add(const Patch& p) {
    positions_.clear();
    normals_.clear();
    for (const PatchVertex& v : scene_.vertices(p)) {
      require(finite(v.position) && finite(v.normal), p.location);
      positions_.push_back(impl_.normalisation.point(v.position));
      normals_.emplace_back(v.normal.normalized());  // a zero normal stays zero
    }
    auto [to, mesh] = part<Mesh>(PrimitiveKind::kPatch, faces(p.material, false));
    finish_mesh(to, mesh.add(positions_, normals_), p.material);
  }

  // `count`: number of Embree primitives, 1 or the number of triangles.
  void finish(ScenePart& to, std::size_t count, MaterialIndex material) const {
    to.materials.insert(to.materials.end(), count, material);
    to.primitives.insert(to.primitives.end(), count, primitive_);
  }

  void finish_mesh(ScenePart& to, std::size_t triangles, MaterialIndex material) {
    if (triangles == 0) return drop();
    finish(to, triangles, material);
    impl_.figures.triangles += triangles;
  }

  void require(bool is_finite, SourceLocation at) const {
    if (!is_finite) reject(scene_.name, at, "a coordinate or radius is not finite");
  }

  void drop() { ++impl_.figures.degenerate; }

  const SceneDescription& scene_;
  CompiledScene::Impl& impl_;
  Repeats repeats_;
  std::uint32_t primitive_ = 0;  // place in the description's order of the primitive that is being added
  std::vector<Vec3d> positions_;
  std::vector<Vec3f> normals_;
};

template <class T>
std::size_t bytes(const std::vector<T>& v) {
  return v.size() * sizeof(T);
}

std::size_t bytes(const ScenePart& part) {
  std::size_t shape = 0;
  if (const auto* mesh = std::get_if<Mesh>(&part.shape)) {
    shape = bytes(mesh->vertices) + bytes(mesh->normals) + bytes(mesh->triangles) + bytes(mesh->facets);
  } else if (const auto* spheres = std::get_if<std::vector<SphereRecord>>(&part.shape)) {
    shape = bytes(*spheres);
  } else {
    shape = bytes(std::get<std::vector<ConeRecord>>(part.shape));
  }
  return shape + bytes(part.materials) + bytes(part.primitives);
}

EmbreeGeometry new_geometry(const EmbreeDevice& device, ScenePart& part) {
  if (auto* mesh = std::get_if<Mesh>(&part.shape)) return new_mesh_geometry(device, *mesh, part.faces);
  if (auto* spheres = std::get_if<std::vector<SphereRecord>>(&part.shape)) {
    return new_user_geometry(device, *spheres, part.faces);
  }
  return new_user_geometry(device, std::get<std::vector<ConeRecord>>(part.shape), part.faces);
}

// Builds Embree's BVH. A part's geometry number is its index in `parts`.
void build_hierarchy(CompiledScene::Impl& impl) {
  const auto start = std::chrono::steady_clock::now();
  std::atomic<std::ptrdiff_t> allocated = 0;
  impl.device = new_embree_device();
  rtcSetDeviceMemoryMonitorFunction(
      impl.device.get(),
      [](void* total, ssize_t change, bool) {
        *static_cast<std::atomic<std::ptrdiff_t>*>(total) += change;
        return true;
      },
      &allocated);
  impl.embree.reset(rtcNewScene(impl.device.get()));
  rtcSetSceneFlags(impl.embree.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(impl.embree.get(), RTC_BUILD_QUALITY_MEDIUM);
  for (std::size_t i = 0; i < impl.parts.size(); ++i) {
    const EmbreeGeometry geometry = new_geometry(impl.device, impl.parts[i]);
    rtcAttachGeometryByID(impl.embree.get(), geometry.get(), static_cast<unsigned>(i));
    impl.figures.primitive_bytes += bytes(impl.parts[i]);
  }
  rtcCommitScene(impl.embree.get());
  rtcSetDeviceMemoryMonitorFunction(impl.device.get(), nullptr, nullptr);
  check_embree(impl.device, "building the hierarchy");
  impl.figures.hierarchy_bytes = static_cast<std::size_t>(std::max<std::ptrdiff_t>(allocated, 0));
  impl.figures.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

EffectSet chosen_effects(const Inventory& inventory, const CompileOptions& options) {
  EffectSet effects = effects_called_for(inventory);
  if (options.effects) effects = effects & *options.effects;
  if (options.max_depth < 2) {
    EffectSet without_secondary = effects;
    without_secondary =
        without_secondary &
        EffectSet(~(static_cast<unsigned>(Effect::kReflection) | static_cast<unsigned>(Effect::kRefraction)));
    return without_secondary;
  }
  return effects;
}

}  // namespace

CompiledScene::CompiledScene(std::unique_ptr<const Impl> impl) : impl_(std::move(impl)) {}
CompiledScene::CompiledScene(CompiledScene&&) noexcept = default;
CompiledScene& CompiledScene::operator=(CompiledScene&&) noexcept = default;
CompiledScene::~CompiledScene() = default;

EffectSet CompiledScene::effects() const {
  return impl_->effects;
}

RepeatedPrimitives CompiledScene::repeated() const {
  return {impl_->figures.repeated, impl_->figures.first_repeated};
}

std::string CompiledScene::census() const {
  return census_text(*impl_);
}

double CompiledScene::distance(const Vec3d& point) const {
  return impl_->normalisation.point(point).length();
}

Camera CompiledScene::camera(const View& view) const {
  const ViewFrame frame = view_frame(view, impl_->name);
  if (!(distance(view.from) <= kFarthestEye)) {
    reject(impl_->name, view.location, "view: the eye is too far away to resolve the scene");
  }
  Camera camera;
  camera.eye = impl_->normalisation.point(view.from);
  camera.forward = frame.forward;
  camera.right = frame.right;
  camera.up = frame.up;
  camera.width = view.width;
  camera.height = view.height;
  camera.slope_per_pixel = frame.slope_per_pixel;
  return camera;
}

CompiledScene compile(const SceneDescription& scene, const CompileOptions& options) {
  const Box3d box = bounds(scene);
  if (scene.primitive_count() == 0 || box.isEmpty()) {
    reject(scene.name, {}, "the scene has no objects: there is nothing in it to see");
  }
  if (!finite(box.max - box.min)) reject(scene.name, {}, "the scene is too large to be measured");

  auto impl = std::make_unique<CompiledScene::Impl>();
  impl->name = scene.name;
  impl->options = options;
  impl->inventory = take_inventory(scene);
  impl->effects = chosen_effects(impl->inventory, options);
  impl->kernel =
      kernel_for(options.general_kernel ? EffectSet::all() : impl->effects, options.count_as_published);
  impl->normalisation = normalising(box, origin_for(scene, box));
  // Enlarged by far more than the rounding of the sum, so that rays may start on the sphere.
  impl->radius = radius_about_origin(impl->normalisation, box) * (1 + 0x1p-20);
  impl->background = to_color(scene.background.value_or(Rgb(0, 0, 0)));

  const double weight = light_weight(scene.lights.size());
  for (const Material& m : scene.materials) impl->materials.push_back(shading_material(m, weight));
  for (const Light& l : scene.lights) {
    if (!finite(l.position)) reject(scene.name, l.location, "the position of a light is not finite");
    impl->lights.push_back(
        {impl->normalisation.point(l.position), to_color(l.color.value_or(Rgb(1, 1, 1)) * weight), {}});
  }
  PartsBuilder(scene, *impl).run();
  std::erase_if(impl->parts, [](const ScenePart& part) { return part.materials.empty(); });
  if (impl->parts.empty()) reject(scene.name, {}, "no object of the scene has any extent");
  for (ShadingLight& light : impl->lights) {
    light.contacts = contacts_of_light(light.position, impl->parts, impl->radius);
  }
  build_hierarchy(*impl);
  return CompiledScene(std::move(impl));
}

}  // namespace pprt
