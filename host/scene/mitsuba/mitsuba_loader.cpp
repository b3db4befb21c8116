// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/mitsuba_loader.h"

#include "host/scene/default_view.h"
#include "host/scene/mitsuba/emitter_maker.h"
#include "host/scene/mitsuba/integrator_maker.h"
#include "host/scene/mitsuba/sensor_maker.h"
#include "host/scene/mitsuba/shape_maker.h"
#include "host/scene/mitsuba/xml_reader.h"
#include "host/scene/named_choice.h"

namespace nearlight::core {
namespace mitsuba {
namespace {

void apply_sensors(const Object& root, const std::string& wanted, Scene& scene, NoteSink& notes) {
    const std::vector<const Object*> sensors = root.nested("sensor");
    std::vector<std::vector<std::string>> names;
    for (const Object* sensor : sensors) {
        names.push_back({sensor->id});
    }
    const std::size_t chosen = choose_named(scene.source, "camera", names, wanted);
    if (sensors.empty()) {
        scene.camera = default_camera(scene);
        notes.remark(scene.source, root.where.line,
                     "the scene has no sensor; a camera that frames everything is added");
        return;
    }
    if (sensors.size() > 1 && wanted.empty()) {
        notes.remark(*sensors[1]->where.file, sensors[1]->where.line,
                     "the scene has several sensors; the first one is used, unless --camera names another");
    }
    apply_sensor(*sensors[chosen], scene, notes);
}

void translate(const Object& root, const std::string& camera, Scene& scene, NoteSink& notes) {
    TextureMaker textures(scene, notes);
    MaterialMaker materials(scene, notes, textures);
    ShapeMaker shapes(scene, notes, textures, materials);
    for (const Object* medium : root.nested("medium")) {
        note(notes, medium->where, kMediaAreLeftOut);
    }
    const std::vector<const Object*> own_shapes = root.nested("shape");
    textures.expect(own_shapes);
    shapes.add_all(own_shapes);
    for (const Object* emitter : root.nested("emitter")) {
        add_emitter(*emitter, scene, textures, notes);
    }
    apply_sensors(root, camera, scene, notes);
    if (const std::vector<const Object*> integrators = root.nested("integrator"); !integrators.empty()) {
        if (integrators.size() > 1) {
            note(notes, integrators[1]->where, "the scene has several integrators; only the last one counts");
        }
        apply_integrator(*integrators.back(), scene, notes);
    }
    for (const char* definitions : {"bsdf", "texture", "film", "sampler", "rfilter"}) {
        root.ignore_nested(definitions);
    }
    root.report_unused(notes);
}

}  // namespace
}  // namespace mitsuba

Scene load_mitsuba_scene(const std::filesystem::path& file, const LoadOptions& options) {
    Scene scene;
    scene.source = file;
    const std::filesystem::path absolute = std::filesystem::absolute(file);
    scene.name = file.stem() == "scene" ? absolute.parent_path().filename().string() : file.stem().string();
    NoteSink notes(scene.notes, options.strict);
    const mitsuba::Document document = mitsuba::read_xml(file, options.parameters, notes);
    mitsuba::translate(*document.scene, options.camera, scene, notes);
    return scene;
}

}  // namespace nearlight::core
