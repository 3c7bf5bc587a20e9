#include "trace/compiled_scene.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <span>
#include <utility>

#include "base/diagnostics.h"
#include "scene/description/shading_rules.h"
#include "scene/description/view_frame.h"
#include "trace/coincident_faces.h"
#include "trace/connected_surfaces.h"
#include "trace/geometry/embree_reach.h"
#include "trace/geometry/numerics.h"
#include "trace/parts_builder.h"
#include "trace/projected_textures.h"
#include "trace/scene_impl.h"
#include "trace/shape_bounds.h"
#include "trace/survey/scene_extent.h"
#include "trace/unshadowed_lights.h"

namespace pprt {
namespace {

// Colours beyond what a sum of floats can hold are as bright as any picture can show.
Color to_color(const Rgb& rgb) {
  static constexpr double kMost = 1e30;
  const auto held = [](double v) { return std::clamp(v, -kMost, kMost); };
  return Color(Rgb(held(rgb.x), held(rgb.y), held(rgb.z)));
}

[[noreturn]] void reject(const std::string& name, SourceLocation at, const std::string& problem) {
  const std::string place =
      at.line > 0 ? name + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) : name;
  throw InputError(place + ": error: " + problem);
}

// Returns the radius of the sphere about the origin that contains the normalised box.
double radius_about_origin(const Normalisation& map, const Box3d& box) {
  const Vec3d low = map.point(box.min), high = map.point(box.max);
  const auto farther = [](double a, double b) { return std::max(std::abs(a), std::abs(b)); };
  return Vec3d(farther(low.x, high.x), farther(low.y, high.y), farther(low.z, high.z)).length();
}

// `ambient`: the ambient light; `reflected`: what materials reflect of it that do not say how much.
ShadingMaterial shading_material(const Material& m, const Rgb& ambient, const Rgb& reflected,
                                 EffectSet effects) {
  ShadingMaterial result;
  result.ambient = to_color(m.terms ? m.terms->ambient * ambient : m.color * reflected);
  if (effects.has(Effect::kEmission)) result.emission = to_color(m.emission);
  result.unlit = result.ambient + result.emission;
  result.diffuse = to_color(m.terms ? m.terms->diffuse : m.color * m.diffuse);
  result.specular_color = to_color(m.terms ? m.terms->specular : Rgb(m.specular, m.specular, m.specular));
  result.specular = static_cast<float>(m.specular);
  result.shine = has_highlight(m) ? static_cast<float>(m.shine) : 0;
  result.transmittance = static_cast<float>(m.transmittance);
  result.reflects_totally = m.terms.has_value();
  result.refractive_index = effective_refractive_index(m);
  result.lit = result.diffuse != Color(0, 0, 0) || result.shine > 0;
  return result;
}

template <class T>
std::size_t bytes(const std::vector<T>& v) {
  return v.size() * sizeof(T);
}

std::size_t bytes(const ScenePart& part) {
  std::size_t shape = 0;
  if (const auto* mesh = std::get_if<Mesh>(&part.shape)) {
    shape = bytes(mesh->vertices) + bytes(mesh->normals) + bytes(mesh->texture_points) +
            bytes(mesh->triangles) + bytes(mesh->facets);
  } else if (const auto* spheres = std::get_if<std::vector<SphereRecord>>(&part.shape)) {
    shape = bytes(*spheres);
  } else {
    shape = bytes(std::get<std::vector<ConeRecord>>(part.shape));
  }
  return shape + bytes(part.materials) + bytes(part.primitives);
}

EmbreeGeometry new_geometry(const EmbreeDevice& device, ScenePart& part) {
  const RayLength rays = part.body == 0 ? RayLength::kUnit : RayLength::kAny;
  if (auto* mesh = std::get_if<Mesh>(&part.shape)) return new_mesh_geometry(device, *mesh, part.faces);
  if (auto* spheres = std::get_if<std::vector<SphereRecord>>(&part.shape)) {
    return new_user_geometry(device, *spheres, part.faces, rays);
  }
  return new_user_geometry(device, std::get<std::vector<ConeRecord>>(part.shape), part.faces, rays);
}

// Builds Embree's BVH of each body that keeps its shape. A part's geometry number is its index in `parts`.
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
  for (CompiledBody& body : impl.bodies) {
    if (body.deforms) continue;
    body.embree.reset(rtcNewScene(impl.device.get()));
    rtcSetSceneFlags(body.embree.get(), RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(body.embree.get(), RTC_BUILD_QUALITY_MEDIUM);
  }
  for (std::size_t i = 0; i < impl.parts.size(); ++i) {
    ScenePart& part = impl.parts[i];
    impl.figures.primitive_bytes += bytes(part);
    if (impl.bodies[part.body].deforms) continue;
    const EmbreeGeometry geometry = new_geometry(impl.device, part);
    rtcAttachGeometryByID(impl.bodies[part.body].embree.get(), geometry.get(), static_cast<unsigned>(i));
  }
  for (const CompiledBody& body : impl.bodies) {
    if (!body.deforms) rtcCommitScene(body.embree.get());
  }
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

void add_materials(const SceneDescription& scene, CompiledScene::Impl& impl) {
  const bool has_textures = impl.effects.has(Effect::kTextures);
  for (const Texture& texture : scene.textures) {
    if (has_textures && texture.width > 0)
      impl.figures.texture_bytes += impl.textures.emplace_back(texture).bytes();
  }
  const Rgb ambient = scene.ambient.value_or(Rgb(1, 1, 1));
  const double weight = scene.ambient ? 1 : light_weight(scene.lights.size());
  for (const Material& m : scene.materials) {
    ShadingMaterial& material = impl.materials.emplace_back(
        shading_material(m, ambient, ambient * (kAmbientReflectance * weight), impl.effects));
    const auto picture = [&](const std::optional<TextureIndex>& texture) {
      return has_textures && texture && *texture < impl.textures.size() ? &impl.textures[*texture] : nullptr;
    };
    material.texture = picture(m.texture);
    material.emission_texture = picture(m.emission_texture);
  }
}

void add_lights(const SceneDescription& scene, CompiledScene::Impl& impl) {
  const double weight = scene.ambient ? 1 : light_weight(scene.lights.size());
  for (const Light& l : scene.lights) {
    if (!is_finite(l.position)) reject(scene.name, l.location, "the position of a light is not finite");
    if (l.is_sun && l.position == Vec3d(0, 0, 0)) reject(scene.name, l.location, "the sun has no direction");
    impl.lights.push_back({compiled_place(l, Affine(), impl.normalisation),
                           to_color(l.color.value_or(Rgb(1, 1, 1)) * weight),
                           {}});
  }
  impl.light_nodes = scene.light_nodes;
  if (!impl.light_nodes.empty()) impl.lights_in_nodes = scene.lights;
}

void set_background(const SceneDescription& scene, CompiledScene::Impl& impl) {
  impl.background = to_color(ground_color(scene));
  if (!impl.effects.has(Effect::kSky)) return;
  impl.sky = {Vec3f(scene.sky->up.normalized()), to_color(scene.sky->horizon),
              to_color(scene.sky->zenith) - to_color(scene.sky->horizon)};
}

void number_parts(std::size_t primitives, CompiledScene::Impl& impl) {
  impl.part_of_primitive.assign(primitives, kNoPart);
  for (std::uint32_t i = 0; i < impl.parts.size(); ++i) {
    for (const std::uint32_t place : impl.parts[i].primitives) impl.part_of_primitive[place] = i;
  }
}

// The parts of a body lie side by side.
void find_coincident_faces(CompiledScene::Impl& impl) {
  for (auto first = impl.parts.begin(); first != impl.parts.end();) {
    const auto end = std::find_if(first, impl.parts.end(),
                                  [&](const ScenePart& part) { return part.body != first->body; });
    if (!impl.bodies[first->body].deforms) impl.figures.coincident += mark_coincident_faces({first, end});
    first = end;
  }
}

// Only where neither the light nor the surface moves. `radius`: of what the scene is measured by.
void find_light_contacts(double radius, CompiledScene::Impl& impl) {
  const auto moving = std::find_if(impl.parts.begin(), impl.parts.end(),
                                   [](const ScenePart& part) { return part.body != 0; });
  const std::span<const ScenePart> resting(impl.parts.begin(), moving);
  for (std::size_t i = 0; i < impl.lights.size(); ++i) {
    const bool rests =
        impl.light_nodes.empty() || (impl.light_nodes[i].node == 0 && impl.light_nodes[i].track.empty());
    if (rests) impl.lights[i].contacts = contacts_of_light(impl.lights[i].position, resting, radius);
  }
}

}  // namespace

Vec3d compiled_place(const Light& light, const Affine& to_world, const Normalisation& map) {
  const Vec3d place = place_of(light, to_world);
  return light.is_sun ? sun_in_reach(place) : light_in_reach(place - map.center, map.scale);
}

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

bool CompiledScene::moves() const {
  return impl_->moves;
}

bool CompiledScene::moves_between(double one, double other) const {
  if (!impl_->moves || one == other) return false;
  const std::vector<Placement> before = placements_at(impl_->movement, one),
                               after = placements_at(impl_->movement, other);
  const auto same = [](const Placement& a, const Placement& b) {
    return a.to_parent == b.to_parent && a.visible == b.visible;
  };
  const bool deforms = std::any_of(impl_->bodies.begin(), impl_->bodies.end(),
                                   [](const CompiledBody& body) { return body.deforms; });
  const auto stands = [&](const LightNode& light) {
    const auto a = track_at(impl_->movement, light.track, one),
               b = track_at(impl_->movement, light.track, other);
    return !a || same(*a, *b);
  };
  return deforms || !std::equal(before.begin(), before.end(), after.begin(), same) ||
         !std::all_of(impl_->light_nodes.begin(), impl_->light_nodes.end(), stands);
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
  const SceneExtent extent = measure(scene);
  if (scene.primitive_count() == 0 || extent.measured.isEmpty()) {
    reject(scene.name, {}, "the scene has no objects: there is nothing in it to see");
  }
  if (!is_finite(extent.shown)) reject(scene.name, {}, "the scene is too large to be measured");

  auto impl = std::make_unique<CompiledScene::Impl>();
  impl->name = scene.name;
  impl->options = options;
  impl->inventory = take_inventory(scene);
  impl->effects = chosen_effects(impl->inventory, options);
  impl->normalisation = extent.normalisation;
  // Enlarged by far more than the rounding of the sum, so that rays may start on the sphere.
  impl->radius = radius_about_origin(impl->normalisation, extent.shown) * (1 + 0x1p-20);
  set_background(scene, *impl);
  impl->movement = scene.movement;
  add_materials(scene, *impl);
  add_lights(scene, *impl);

  build_parts(scene, *impl);
  std::erase_if(impl->parts, [](const ScenePart& part) { return part.materials.empty(); });
  if (impl->parts.empty()) reject(scene.name, {}, "no object of the scene has any extent");
  impl->moves = impl->bodies.size() > 1 || !impl->light_nodes.empty();
  number_parts(scene.order.size(), *impl);
  find_coincident_faces(*impl);
  find_light_contacts(radius_about_origin(impl->normalisation, extent.measured), *impl);
  impl->surfaces = connected_surfaces(impl->parts, static_cast<std::uint32_t>(scene.order.size()));
  for (ScenePart& part : impl->parts)
    if (const auto* mesh = std::get_if<Mesh>(&part.shape); mesh != nullptr && part.shapes.empty())
      part.boxes = boxes_of(*mesh);
  impl->with_pictures = primitives_with_pictures(*impl);
  impl->lit_surfaces = lit_surfaces(*impl);
  build_hierarchy(*impl);
  return CompiledScene(std::move(impl));
}

}  // namespace pprt
