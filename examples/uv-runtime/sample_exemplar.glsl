// Samples a material at run time through its uv map: GLSL ES 3.00 (WebGL 2), and desktop GLSL from 3.30 on.
// examples/guide/uv-runtime.md describes the textures and argues for every choice; sample_exemplar.hlsl is the same.
//
//   vec2 size = vec2(textureSize(uvMap, 0));
//   ExemplarFootprint f = exemplarFootprint(dFdx(st * size), dFdy(st * size), 1);
//   ExemplarPlace place = placeInExemplar(st, f.texels);
//   vec3 color = sampleExemplar(baseColor, farBaseColor, place).rgb;
//   vec3 normal = normalize(sampleExemplar(normals, farNormals, place).xyz * 2.0 - 1.0);
//
// `st` is the coordinate that one would sample the resolved maps at. Define EXEMPLAR_PACKED_UV for a packed uv map.

precision highp float;
precision highp int;

#ifdef EXEMPLAR_PACKED_UV
uniform highp usampler2D uvMap;      // R8UI: for each output texel an index into the palette of its tile
uniform highp usampler2D uvPalette;  // RG16UI: 16 entries a row, uvPaletteRows rows for each tile
uniform int uvTileShift;             // tiles have 2^uvTileShift texels a side
uniform int uvPaletteRows;
#else
uniform highp usampler2D uvMap;      // RG16UI: for each output texel the exemplar pixel it shows
#endif
uniform ivec2 exemplarSize;          // in pixels, of the exemplar that the uv map was made for
uniform bvec2 outputWraps;           // the result is tileable in x, in y
uniform int farLevel;                // the mip level of the resolved maps that the far maps begin with, at least 1

// Four places in the exemplar, and what each counts.
struct ExemplarTaps {
  vec2 st[4];
  vec4 weights;
  float level;     // of the exemplar's mips
  bool continuous; // all four lie in one piece: the first says it all
};

struct ExemplarPlace {
  ExemplarTaps fine;
  ExemplarTaps coarse;  // one level further
  float blend;          // from fine to coarse
  int level;            // of `fine`
  vec2 st;
  float farLod;
};

struct ExemplarFootprint {
  float texels;  // side of the square that one probe covers, in output texels
  int probes;
  vec2 step;     // from probe to probe, in output texels
};

ivec2 exemplarPixel(ivec2 texel) {
  uvec2 stored = texelFetch(uvMap, texel, 0).rg;
#ifdef EXEMPLAR_PACKED_UV
  ivec2 tile = texel >> uvTileShift;
  int entry = int(stored.r);
  ivec2 offset = ivec2(texelFetch(uvPalette, ivec2(tile.x * 16 + (entry & 15), tile.y * uvPaletteRows + (entry >> 4)), 0).rg);
  return (texel + offset) % exemplarSize;
#else
  return ivec2(stored);
#endif
}

// `p` in output texels. Level l of the uv map is every 2^l-th texel of it, the one right and below of its block's
// centre, so no level but the first is stored.
ExemplarTaps exemplarTaps(vec2 p, int level) {
  ivec2 size = textureSize(uvMap, 0);
  int stride = 1 << level;
  vec2 q = p / float(stride) - 0.5;
  vec2 cell = floor(q);
  vec2 f = q - cell;
  ExemplarTaps taps;
  taps.weights = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
  taps.level = float(level);
  taps.continuous = true;
  ivec2 first = ivec2(0);
  for (int i = 0; i < 4; i++) {
    ivec2 texel = (ivec2(cell) + ivec2(i & 1, i >> 1)) * stride + stride / 2;
    ivec2 wrapped = (texel + size) % size, held = clamp(texel, ivec2(0), size - 1);
    ivec2 e = exemplarPixel(ivec2(outputWraps.x ? wrapped.x : held.x, outputWraps.y ? wrapped.y : held.y));
    // The texel's piece goes on as far as p. Exact: texel and p are small numbers, and their difference smaller.
    taps.st[i] = (vec2(e) + (p - vec2(texel))) / vec2(exemplarSize);
    ivec2 origin = e - texel;
    if (i == 0) first = origin;
    taps.continuous = taps.continuous && origin == first;
  }
  return taps;
}

// `texels`: side of what the probe covers, from the derivatives of the output coordinate. Those of the exemplar
// coordinate are no use: it jumps at seams, and a quad of pixels across one would take the coarsest mip.
ExemplarPlace placeInExemplar(vec2 st, float texels) {
  vec2 size = vec2(textureSize(uvMap, 0));
  float lod = max(log2(max(texels, 1e-6)), 0.0);
  ExemplarPlace place;
  place.level = int(lod);
  place.blend = lod - float(place.level);
  place.st = st;
  place.farLod = lod - float(farLevel);
  vec2 inside = vec2(outputWraps.x ? fract(st.x) : st.x, outputWraps.y ? fract(st.y) : st.y);
  if (place.level < farLevel) place.fine = exemplarTaps(inside * size, place.level);
  if (place.blend > 0.0 && place.level + 1 < farLevel) place.coarse = exemplarTaps(inside * size, place.level + 1);
  return place;
}

vec4 sampleTaps(sampler2D exemplar, ExemplarTaps taps) {
  vec4 value = textureLod(exemplar, taps.st[0], taps.level);
  if (taps.continuous) return value;
  value *= taps.weights.x;
  value += taps.weights.y * textureLod(exemplar, taps.st[1], taps.level);
  value += taps.weights.z * textureLod(exemplar, taps.st[2], taps.level);
  value += taps.weights.w * textureLod(exemplar, taps.st[3], taps.level);
  return value;
}

// `exemplar`: a map with mips, linear between texels; it repeats if the exemplar tiles, else it is clamped. `far`: the
// same map resolved, from level farLevel on; it repeats where the result does. Colours in sRGB textures are blended
// linearly. Normals come back shortened where they differ: normalize them.
vec4 sampleExemplar(sampler2D exemplar, sampler2D far, ExemplarPlace place) {
  if (place.level >= farLevel) return textureLod(far, place.st, place.farLod);
  vec4 fine = sampleTaps(exemplar, place.fine);
  if (place.blend == 0.0) return fine;
  vec4 coarse = place.level + 1 < farLevel ? sampleTaps(exemplar, place.coarse) : textureLod(far, place.st, 0.0);
  return mix(fine, coarse, place.blend);
}

// From the derivatives of the output coordinate in texels. With more than one probe, surfaces seen at an angle stay
// sharp: take the mean of sampleExemplar over
//   placeInExemplar(st + (float(i) - 0.5 * float(f.probes - 1)) * f.step / size, f.texels)   for i from 0 to f.probes - 1.
ExemplarFootprint exemplarFootprint(vec2 dx, vec2 dy, int mostProbes) {
  float a = length(dx), b = length(dy);
  vec2 major = a > b ? dx : dy;
  float longer = max(a, b), shorter = min(a, b);
  ExemplarFootprint f;
  f.probes = clamp(int(ceil(longer / max(shorter, 1.0) - 0.01)), 1, mostProbes);
  f.texels = longer / float(f.probes);
  f.step = major / float(f.probes);
  return f;
}
