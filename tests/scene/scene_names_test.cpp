// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene_names.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "tests/scene/gltf_text.h"
#include "tests/scene/mitsuba_text.h"
#include "tests/scene/scene_files.h"

namespace nearlight::core {
namespace {

using test::SceneFiles;
using testing::ElementsAre;

/// The name of each triangle, without repeats.
std::vector<std::string> names(const Scene& scene, NamedKind kind) {
    const TriangleNames of_triangles(scene, kind);
    std::vector<std::string> result;
    for (uint i = 0; i < scene.triangles.size(); ++i) {
        const std::string name(of_triangles.name(of_triangles.number_of(i)));
        if (result.empty() || result.back() != name) {
            result.push_back(name);
        }
    }
    return result;
}
std::vector<std::string> objects(const Scene& scene) {
    return names(scene, NamedKind::object);
}
std::vector<std::string> materials(const Scene& scene) {
    return names(scene, NamedKind::material);
}

TEST(SceneNames, OfMitsubaAreIdsOrTypesAndPlaces) {
    const SceneFiles files;
    const Scene scene = files.load_xml(R"(
<bsdf type='diffuse' id='chalk'/>
<shape type='rectangle' id='floor'><ref id='chalk'/></shape>
<shape type='cube'><bsdf type='twosided'><bsdf type='diffuse' id='paint'/></bsdf></shape>
<shape type='rectangle'><bsdf type='conductor'/></shape>
<shape type='rectangle' id='lamp'><ref id='chalk'/><emitter type='area'><rgb name='radiance' value='1'/></emitter></shape>
<shape type='rectangle' id='bare'/>)");
    EXPECT_THAT(objects(scene), ElementsAre("floor", "cube 2", "rectangle 3", "lamp", "bare"));
    EXPECT_THAT(materials(scene), ElementsAre("chalk", "paint", "conductor 3", "chalk", "default"));
}

TEST(SceneNames, OfMitsubasFilesAndInstancesSayWhichTheyAre) {
    const SceneFiles files;
    files.write("leaf.obj", "o other\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const Scene scene = files.load_xml(R"(
<shape type='shapegroup' id='tree'>
  <shape type='obj'><string name='filename' value='leaf.obj'/></shape>
  <shape type='rectangle' id='trunk'/>
</shape>
<shape type='instance' id='oak'><ref id='tree'/></shape>
<shape type='instance'><ref id='tree'/></shape>
<shape type='obj'><string name='filename' value='leaf.obj'/></shape>)");
    EXPECT_THAT(objects(scene),
                ElementsAre("oak/leaf 1", "oak/trunk", "instance 2/leaf 2", "instance 2/trunk", "leaf 3"));
}

TEST(SceneNames, OfObjAreTheLastObjectOrGroup) {
    const SceneFiles files;
    const Scene scene = load_scene(files.write("model.obj", R"(v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
f 1 2 3
o Cup
g a b
f 1 2 3
f 1 2 4
usemtl Tin
f 2 3 4
o Cup
f 1 3 4
g a b
f 1 2 3
)"));
    EXPECT_THAT(objects(scene), ElementsAre("default", "a b", "Cup", "a b"));
    EXPECT_EQ(scene.object_names.size(), 2u) << "a name that comes back needs no room";
    EXPECT_THAT(materials(scene), ElementsAre("default", "Tin"));
    const std::vector<std::string_view> used = TriangleNames(scene, NamedKind::object).used();
    EXPECT_THAT(used, ElementsAre("Cup", "a b", "default"));
}

/// Left-out triangles must not move the names of others.
TEST(SceneNames, OfObjStayWithTheirTriangles) {
    const SceneFiles files;
    const Scene scene = load_scene(files.write("model.obj",
                                               "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1e39 0 0\no one\nf 1 2 4\nf 1 2 "
                                               "3\no two\nf 1 2 4\no three\nf 3 2 1\n"));
    ASSERT_EQ(scene.triangles.size(), 2u);
    EXPECT_THAT(objects(scene), ElementsAre("one", "three"));
    EXPECT_THAT(TriangleNames(scene, NamedKind::object).used(), ElementsAre("one", "three"));
}

class GltfNames : public test::GltfLoader {};

TEST_F(GltfNames, AreThoseOfNodesOrMeshesAndMaterials) {
    gltf_.root["meshes"][0]["name"] = "square";
    gltf_.root["scenes"] = {{{"nodes", {0, 1, 2}}}};
    gltf_.root["nodes"].push_back({{"mesh", 0}});
    gltf_.root["nodes"].push_back({{"mesh", 1}});
    gltf_.root["meshes"].push_back(gltf_.root["meshes"][0]);
    gltf_.root["meshes"][1].erase("name");
    gltf_.root["meshes"][1]["primitives"][0]["material"] = 1;
    gltf_.root["materials"].push_back({{"name", "clay"}});
    const Scene scene = load();
    EXPECT_THAT(objects(scene), ElementsAre("thing", "square", "node 3"));
    EXPECT_THAT(materials(scene), ElementsAre("material 1", "clay"));
}

TEST(SceneNames, OfScenesWithoutNamesAreDefault) {
    Scene scene;
    scene.triangles.resize(2);
    EXPECT_THAT(objects(scene), ElementsAre("default"));
    EXPECT_THAT(materials(scene), ElementsAre("default"));
    EXPECT_THAT(TriangleNames(scene, NamedKind::object).used(), ElementsAre("default"));
    begin_object(scene, "nothing");
    EXPECT_THAT(TriangleNames(scene, NamedKind::object).used(), ElementsAre("default"));
}

}  // namespace
}  // namespace nearlight::core
