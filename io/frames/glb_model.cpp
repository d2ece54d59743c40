// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// glTF 2.0 by tinygltf, which is included in this file only.
#include "io/frames/glb_model.h"

#include <fstream>  // which tinygltf 2.7 lacks without its file functions

// tinygltf is header-only. A namespace of our own prevents clashes with another copy, maybe of another version, in the
// program.
#define tinygltf bullet_fem_tinygltf
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>
#include <stdexcept>

#include "bullet_fem/io/colour_map.h"

namespace bullet_fem
{
namespace
{

namespace gltf = tinygltf;

constexpr double kPlainColours[6][3] = {{0.55, 0.60, 0.68}, {0.80, 0.50, 0.30}, {0.40, 0.65, 0.45},
                                        {0.70, 0.40, 0.55}, {0.85, 0.75, 0.40}, {0.35, 0.55, 0.75}};  // linear colour

/// A glTF document under construction. All numbers have four bytes, so everything is aligned.
class Document
{
public:
    Document()
    {
        m_model.asset.version = "2.0";
        m_model.asset.generator = "BulletFEM";
        m_model.buffers.emplace_back();
        m_model.scenes.emplace_back();
        m_model.defaultScene = 0;
    }

    /// Begins a buffer view for the following append() calls; `target` 0: neither vertices nor indices.
    void beginView(int target)
    {
        gltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = bytes().size();
        view.target = target;
        if (target == TINYGLTF_TARGET_ARRAY_BUFFER) view.byteStride = sizeof(Float3);  // several accessors share it
        m_model.bufferViews.push_back(view);
    }

    int append(const std::vector<Float3>& vectors, bool bounded)
    {
        return append(vectors, {TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3}, bounded ? &vectors[0][0] : nullptr);
    }
    int append(const std::vector<float>& numbers, bool bounded)
    {
        return append(numbers, {TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_SCALAR}, bounded ? &numbers[0] : nullptr);
    }
    int append(const std::vector<std::uint32_t>& numbers)
    {
        return append(numbers, {TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR}, nullptr);
    }

    gltf::Model& model() { return m_model; }

    std::string file()
    {
        std::ostringstream stream;
        gltf::TinyGLTF writer;
        if (!writer.WriteGltfSceneToStream(&m_model, stream, false, true))
            throw std::runtime_error("tinygltf could not write the film");
        return stream.str();
    }

private:
    struct Kind
    {
        int m_component, m_type;
    };

    // Adds an accessor of the last view, with minimum and maximum of each component if `floats` are given.
    template <class Value>
    int append(const std::vector<Value>& values, const Kind& kind, const float* floats)
    {
        gltf::BufferView& view = m_model.bufferViews.back();
        gltf::Accessor accessor;
        accessor.bufferView = static_cast<int>(m_model.bufferViews.size()) - 1;
        accessor.byteOffset = bytes().size() - view.byteOffset;
        accessor.componentType = kind.m_component;
        accessor.type = kind.m_type;
        accessor.count = values.size();
        if (floats) setBounds(accessor, floats);
        const std::size_t size = values.size() * sizeof(Value), begin = bytes().size();
        bytes().resize(begin + size);
        std::memcpy(&bytes()[begin], values.data(), size);
        view.byteLength += size;
        m_model.accessors.push_back(std::move(accessor));
        return static_cast<int>(m_model.accessors.size()) - 1;
    }

    static void setBounds(gltf::Accessor& accessor, const float* floats)
    {
        const std::size_t components = accessor.type == TINYGLTF_TYPE_VEC3 ? 3 : 1;
        accessor.minValues.assign(floats, floats + components);
        accessor.maxValues = accessor.minValues;
        for (std::size_t i = 0; i < accessor.count * components; ++i)
        {
            double &least = accessor.minValues[i % components], &most = accessor.maxValues[i % components];
            least = std::min(least, static_cast<double>(floats[i]));
            most = std::max(most, static_cast<double>(floats[i]));
        }
    }

    std::vector<unsigned char>& bytes() { return m_model.buffers[0].data; }

    gltf::Model m_model;
};

/// Unit normals of the vertices: the triangles' areas, summed.
std::vector<Float3> normalsOf(const GlbBody& body, std::size_t frame)
{
    const std::vector<Float3>& x = body.m_position[frame];
    const auto at = [&x](int v) { return Vec3{x[v][0], x[v][1], x[v][2]}; };
    std::vector<Vec3> sum(x.size());
    for (const Triangle& t : body.m_triangles)
    {
        const Vec3 area = cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]));
        for (const int v : t) sum[v] += area;
    }
    std::vector<Float3> normals;
    for (const Vec3& n : sum)
    {
        const double length = norm(n);
        const Vec3 unit = length > 0 ? (1 / length) * n : Vec3{0, 1, 0};  // arbitrary where the triangles have no area
        normals.push_back({static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z)});
    }
    return normals;
}

std::vector<Float3> coloursOf(const std::vector<float>& vonMises, double hottest)
{
    std::vector<Float3> colours;
    for (const float s : vonMises)
    {
        const Vec3 c = linearColour(viridis(s / hottest));
        colours.push_back({static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)});
    }
    return colours;
}

std::vector<float> peakOf(const std::vector<std::vector<float>>& frames)
{
    std::vector<float> peak = frames[0];
    for (const std::vector<float>& frame : frames)
        for (std::size_t v = 0; v < peak.size(); ++v) peak[v] = std::max(peak[v], frame[v]);
    return peak;
}

std::vector<Float3> difference(std::vector<Float3> a, const std::vector<Float3>& b)
{
    for (std::size_t v = 0; v < a.size(); ++v)
        for (int i = 0; i < 3; ++i) a[v][i] -= b[v][i];
    return a;
}

/// Vertex attributes of a frame: of frame 0 those of the mesh, of other frames a morph target, that is the differences
/// from frame 0.
std::map<std::string, int> appendFrame(Document& document, const GlbModel& film, const GlbBody& body, std::size_t frame)
{
    std::map<std::string, int> attributes;
    const auto add = [&](const char* name, const auto& valuesOf, bool bounded) {
        attributes[name] =
            document.append(frame == 0 ? valuesOf(0) : difference(valuesOf(frame), valuesOf(0)), bounded);
    };
    add(
        "POSITION", [&](std::size_t k) { return body.m_position[k]; }, true);
    if (film.m_normals)
        add(
            "NORMAL", [&](std::size_t k) { return normalsOf(body, k); }, false);
    if (film.m_hottest > 0 && !(film.m_peakColours && frame > 0))
    {
        const auto stress = [&](std::size_t k)
        { return film.m_peakColours ? peakOf(body.m_vonMises) : body.m_vonMises[k]; };
        add(
            "COLOR_0", [&](std::size_t k) { return coloursOf(stress(k), film.m_hottest); }, false);
    }
    return attributes;
}

void appendMaterial(Document& document, const double (&colour)[3])
{
    gltf::Material material;
    material.pbrMetallicRoughness.baseColorFactor = {colour[0], colour[1], colour[2], 1};
    material.pbrMetallicRoughness.metallicFactor = 0;
    material.pbrMetallicRoughness.roughnessFactor = 0.7;
    material.doubleSided = true;
    document.model().materials.push_back(material);
}

void appendBody(Document& document, const GlbModel& film, const GlbBody& body)
{
    gltf::Model& model = document.model();
    std::vector<std::uint32_t> corners;
    for (const Triangle& t : body.m_triangles)
        for (const int v : t) corners.push_back(static_cast<std::uint32_t>(v));

    gltf::Primitive surface;
    surface.mode = TINYGLTF_MODE_TRIANGLES;
    surface.material = static_cast<int>(model.materials.size());
    document.beginView(TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    surface.indices = document.append(corners);
    document.beginView(TINYGLTF_TARGET_ARRAY_BUFFER);
    surface.attributes = appendFrame(document, film, body, 0);
    for (std::size_t k = 1; k < film.m_times.size(); ++k)
        surface.targets.push_back(appendFrame(document, film, body, k));

    constexpr double white[3] = {1, 1, 1};
    appendMaterial(document, film.m_hottest > 0 ? white : kPlainColours[model.materials.size() % 6]);
    gltf::Mesh mesh;
    mesh.primitives.push_back(std::move(surface));
    model.meshes.push_back(std::move(mesh));
    gltf::Node node;
    node.name = "body " + std::to_string(body.m_id);
    if (film.m_zUp) node.rotation = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)};  // z to y, about x
    node.mesh = static_cast<int>(model.meshes.size()) - 1;
    model.nodes.push_back(node);
    model.scenes[0].nodes.push_back(static_cast<int>(model.nodes.size()) - 1);
}

/// At the time of frame k, target k has weight 1 and all others 0; linear interpolation of the weights moves every
/// vertex along a straight line between frames.
void appendAnimation(Document& document, const GlbModel& film)
{
    const std::size_t frames = film.m_times.size();
    std::vector<float> weights(frames * (frames - 1), 0.0f);
    for (std::size_t k = 1; k < frames; ++k) weights[k * (frames - 1) + k - 1] = 1;
    gltf::AnimationSampler sampler;
    document.beginView(0);
    sampler.input = document.append(film.m_times, true);
    sampler.output = document.append(weights, false);
    sampler.interpolation = film.m_stepped ? "STEP" : "LINEAR";
    gltf::Animation animation;
    animation.name = "run";
    animation.samplers.push_back(sampler);
    for (std::size_t b = 0; b < film.m_bodies.size(); ++b)
    {
        gltf::AnimationChannel channel;
        channel.sampler = 0;
        channel.target_node = static_cast<int>(b);
        channel.target_path = "weights";
        animation.channels.push_back(channel);
    }
    document.model().animations.push_back(std::move(animation));
}

}  // namespace

std::string glbBytes(const GlbModel& film)
{
    Document document;
    for (const GlbBody& body : film.m_bodies) appendBody(document, film, body);
    if (film.m_times.size() > 1) appendAnimation(document, film);
    if (film.m_hottest > 0)
        document.model().asset.extras =
            gltf::Value(gltf::Value::Object{{"hottest_von_mises_pa", gltf::Value(film.m_hottest)}});
    return document.file();
}

}  // namespace bullet_fem
