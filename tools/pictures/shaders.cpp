// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/shaders.h"

namespace bullet_fem
{
namespace
{

/// Lighting at a point, shared by surfaces and ground. Shadows widen with the distance between caster and receiver
/// [Fernando 2005, percentage-closer soft shadows]. Occlusion of the sky comes from a map of heights seen from above:
/// higher objects nearby reduce the light.
constexpr const char* kLight = R"(
uniform mat4 keyFromScene, skyFromScene;        // to [0, 1]^3
uniform float keyWidth, keyDepth, skyWidth, skyDepth;
uniform float lightSize;
uniform bool shadows;
uniform vec3 towardsKey, towardsFill, towardsRim, upwards, eye;
uniform sampler2D keyDepths, skyDepths;
uniform sampler2DShadow keyShadow;

const float golden = 2.39996323;
vec2 disk(int i, int n)
{
    float r = sqrt((float(i) + 0.5) / float(n)), a = golden * float(i);
    return r * vec2(cos(a), sin(a));
}

float keyLight(vec3 p, vec3 n)
{
    if (!shadows) return 1.0;
    vec3 q = (keyFromScene * vec4(p + 0.006 * n, 1.0)).xyz;
    if (any(lessThan(q, vec3(0.0))) || any(greaterThan(q, vec3(1.0)))) return 1.0;
    float search = (0.25 * lightSize + 0.004) / keyWidth;
    float blockers = 0.0, depth = 0.0;
    for (int i = 0; i < 16; ++i)
    {
        float d = texture(keyDepths, q.xy + search * disk(i, 16)).r;
        if (d < q.z - 0.002)
        {
            blockers += 1.0;
            depth += d;
        }
    }
    if (blockers == 0.0) return 1.0;
    float gap = (q.z - depth / blockers) * keyDepth;
    float radius = max(0.5 * lightSize * gap, 0.003) / keyWidth;
    float lit = 0.0;
    for (int i = 0; i < 32; ++i) lit += texture(keyShadow, vec3(q.xy + radius * disk(i, 32), q.z - 0.0005));
    return lit / 32.0;
}

float skyLight(vec3 p, vec3 n)
{
    if (!shadows) return 1.0;
    const float reach = 0.22;
    vec3 q = (skyFromScene * vec4(p + 0.012 * n, 1.0)).xyz;
    if (any(lessThan(q.xy, vec2(0.0))) || any(greaterThan(q.xy, vec2(1.0)))) return 1.0;
    float taken = 0.0;
    for (int i = 0; i < 16; ++i)
    {
        vec2 way = reach * disk(i, 16);
        float higher = (q.z - texture(skyDepths, q.xy + way / skyWidth).r) * skyDepth;
        taken += clamp(higher / (length(way) + 0.03), 0.0, 1.0) / (1.0 + 6.0 * higher * higher);
    }
    return 1.0 - 0.75 * taken / 16.0;
}

vec3 linear(vec3 c) { return pow(c, vec3(2.2)); }
vec3 screen(vec3 c)
{
    c = mix(c, 1.0 - 0.35 * exp(-(c - 0.65) / 0.35), vec3(greaterThan(c, vec3(0.65))));  // highlights do not burn out
    return pow(clamp(c, 0.0, 1.0), vec3(1.0 / 2.2));
}

vec3 shaded(vec3 base, vec3 p, vec3 n, float gloss)
{
    vec3 v = normalize(eye - p);
    float key = max(dot(n, towardsKey), 0.0);
    if (key > 0.0) key *= keyLight(p, n);
    float fill = pow(0.5 + 0.5 * dot(n, towardsFill), 2.0), sky = 0.5 + 0.5 * dot(n, upwards);
    float rim = max(dot(n, towardsRim), 0.0) * pow(1.0 - max(dot(n, v), 0.0), 2.0);
    float open = skyLight(p, n);
    vec3 light = vec3(0.90, 0.87, 0.82) * key + open * (vec3(0.10, 0.115, 0.14) * fill +
                 mix(vec3(0.20, 0.195, 0.19), vec3(0.31, 0.33, 0.36), sky));
    vec3 half_ = normalize(towardsKey + v);
    float shine = gloss * pow(max(dot(n, half_), 0.0), 40.0) * key;
    return base * light + vec3(0.16, 0.17, 0.19) * shine + 0.30 * gloss * rim * open * mix(base, vec3(1.0), 0.4);
}
)";

}  // namespace

std::string surfaceVertexShader()
{
    return R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in float shareOfMap;
uniform mat4 clipFromScene;
centroid out vec3 place, direction, corner;
centroid out float share;
void main()
{
    place = position;
    direction = normal;
    share = shareOfMap;
    int c = gl_VertexID % 3;
    corner = vec3(c == 0, c == 1, c == 2);
    gl_Position = clipFromScene * vec4(position, 1.0);
}
)";
}

std::string surfaceFragmentShader()
{
    return std::string(kLight) + R"(
centroid in vec3 place, direction, corner;
centroid in float share;
uniform vec3 colour;
uniform bool coloured, lit, wires;
uniform float wireWidth, opacity;  // [pixels], [-]
uniform sampler2D colourMap;
out vec4 pixel;
void main()
{
    vec3 base = colour;
    if (coloured) base = texture(colourMap, vec2((clamp(share, 0.0, 1.0) * 255.0 + 0.5) / 256.0, 0.5)).rgb;
    vec3 n = normalize(direction);
    if (!gl_FrontFacing) n = -n;
    vec3 c = lit ? screen(shaded(linear(base), place, n, coloured ? 0.35 : 1.0)) : base;
    if (wires)
    {
        vec3 d = corner / fwidth(corner);  // pixels from each edge
        float line = 1.0 - smoothstep(0.5 * wireWidth - 0.5, 0.5 * wireWidth + 0.5, min(d.x, min(d.y, d.z)));
        c = mix(c, 0.25 * c, 0.75 * line);
    }
    pixel = vec4(c, opacity);
}
)";
}

std::string depthVertexShader()
{
    return R"(
layout(location = 0) in vec3 position;
uniform mat4 clipFromScene;
void main() { gl_Position = clipFromScene * vec4(position, 1.0); }
)";
}

std::string depthFragmentShader()
{
    return "void main() {}\n";
}

std::string groundVertexShader()
{
    return R"(
uniform mat4 clipFromScene;
uniform vec3 centre, side0, side1;  // side0 and side1 of length 1
uniform float extent;
out vec3 place;
out vec2 onGround;
void main()
{
    vec2 corner = vec2(gl_VertexID % 2 == 0 ? -1.0 : 1.0, gl_VertexID / 2 == 0 ? -1.0 : 1.0);
    onGround = extent * corner;
    place = centre + onGround.x * side0 + onGround.y * side1;
    gl_Position = clipFromScene * vec4(place, 1.0);
}
)";
}

std::string groundFragmentShader()
{
    return std::string(kLight) + R"(
in vec3 place;
in vec2 onGround;
uniform vec3 colour;
uniform float spacing, extent;
uniform vec2 gridOrigin;
uniform float wireWidth;  // [pixels]
out vec4 pixel;
float lines(float every)
{
    vec2 g = (onGround - gridOrigin) / every, w = fwidth(g);
    vec2 d = abs(fract(g - 0.5) - 0.5) / w;  // pixels from the nearest line
    vec2 line = 1.0 - smoothstep(0.5 * wireWidth - 0.5, 0.5 * wireWidth + 0.5, d);
    line *= 1.0 - smoothstep(0.12, 0.35, w);  // where lines would be denser than pixels, none
    return max(line.x, line.y);
}
void main()
{
    float away = length(onGround) / extent;
    vec3 base = linear(colour);
    if (spacing > 0.0) base *= 1.0 - (0.10 * lines(spacing) + 0.10 * lines(5.0 * spacing)) * (1.0 - smoothstep(0.1, 0.6, away));
    vec3 c = screen(shaded(base, place, upwards, 0.0));
    pixel = vec4(c, 1.0 - smoothstep(0.15, 0.85, away));
}
)";
}

std::string backgroundVertexShader()
{
    return R"(
out float height;
void main()
{
    vec2 p = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    height = p.y;
    gl_Position = vec4(p, 1.0, 1.0);
}
)";
}

std::string backgroundFragmentShader()
{
    return R"(
in float height;
uniform vec3 sky, horizon;
out vec4 pixel;
void main() { pixel = vec4(mix(horizon, sky, smoothstep(-0.1, 1.3, height)), 1.0); }
)";
}

std::string overlayVertexShader()
{
    return R"(
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 texel;
layout(location = 2) in vec4 colour;
uniform vec2 size;
out vec2 place;
out vec4 tint;
void main()
{
    place = texel;
    tint = colour;
    gl_Position = vec4(2.0 * position.x / size.x - 1.0, 1.0 - 2.0 * position.y / size.y, 0.0, 1.0);
}
)";
}

std::string overlayFragmentShader()
{
    return R"(
in vec2 place;
in vec4 tint;
uniform int kind;  // 0: plain, 1: glyphs, 2: colour map
uniform sampler2D glyphs, colourMap;
out vec4 pixel;
void main()
{
    pixel = tint;
    if (kind == 1) pixel.a *= texture(glyphs, place).r;
    if (kind == 2) pixel.rgb = texture(colourMap, vec2((place.x * 255.0 + 0.5) / 256.0, 0.5)).rgb;
}
)";
}

}  // namespace bullet_fem
