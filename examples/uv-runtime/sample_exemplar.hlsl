// Samples a material at run time through its uv map: HLSL, shader model 5. The same as sample_exemplar.glsl;
// examples/guide/uv-runtime.md describes the textures and argues for every choice.
//
//   ExemplarFootprint f = exemplarFootprint(ddx(st * uvSize), ddy(st * uvSize), 1);
//   ExemplarPlace place = placeInExemplar(st, f.texels);
//   float3 color = sampleExemplar(baseColor, farBaseColor, place).rgb;
//   float3 normal = normalize(sampleExemplar(normals, farNormals, place).xyz * 2.0 - 1.0);
//
// `st` is the coordinate that one would sample the resolved maps at. Define EXEMPLAR_PACKED_UV for a packed uv map.

#ifdef EXEMPLAR_PACKED_UV
Texture2D<uint> uvMap;          // R8_UINT: for each output texel an index into the palette of its tile
Texture2D<uint2> uvPalette;     // R16G16_UINT: 16 entries a row, uvPaletteRows rows for each tile
#else
Texture2D<uint2> uvMap;         // R16G16_UINT: for each output texel the exemplar pixel it shows
#endif
SamplerState exemplarSampler;   // linear, with mips; wraps if the exemplar tiles, else clamps
SamplerState farSampler;        // linear, with mips; wraps where the result does

cbuffer Exemplar {
  int2 uvSize;                  // in texels
  int2 exemplarSize;            // in pixels, of the exemplar that the uv map was made for
  bool2 outputWraps;            // the result is tileable in x, in y
  int farLevel;                 // the mip level of the resolved maps that the far maps begin with, at least 1
  int uvTileShift;              // packed: tiles have 2^uvTileShift texels a side
  int uvPaletteRows;            // packed
};

// Four places in the exemplar, and what each counts.
struct ExemplarTaps {
  float2 st[4];
  float4 weights;
  float level;      // of the exemplar's mips
  bool continuous;  // all four lie in one piece: the first says it all
};

struct ExemplarPlace {
  ExemplarTaps fine;
  ExemplarTaps coarse;  // one level further
  float blend;          // from fine to coarse
  int level;            // of `fine`
  float2 st;
  float farLod;
};

struct ExemplarFootprint {
  float texels;  // side of the square that one probe covers, in output texels
  int probes;
  float2 step;   // from probe to probe, in output texels
};

int2 exemplarPixel(int2 texel) {
#ifdef EXEMPLAR_PACKED_UV
  int2 tile = texel >> uvTileShift;
  int entry = int(uvMap.Load(int3(texel, 0)));
  int2 at = int2(tile.x * 16 + (entry & 15), tile.y * uvPaletteRows + (entry >> 4));
  return int2(uint2(texel + int2(uvPalette.Load(int3(at, 0)))) % uint2(exemplarSize));
#else
  return int2(uvMap.Load(int3(texel, 0)));
#endif
}

// `p` in output texels. Level l of the uv map is every 2^l-th texel of it, the one right and below of its block's
// centre, so no level but the first is stored.
ExemplarTaps exemplarTaps(float2 p, int level) {
  int stride = 1 << level;
  float2 q = p / float(stride) - 0.5;
  float2 cell = floor(q);
  float2 f = q - cell;
  ExemplarTaps taps;
  taps.weights = float4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
  taps.level = float(level);
  taps.continuous = true;
  int2 first = int2(0, 0);
  [unroll] for (int i = 0; i < 4; i++) {
    int2 texel = (int2(cell) + int2(i & 1, i >> 1)) * stride + stride / 2;
    int2 wrapped = int2(uint2(texel + uvSize) % uint2(uvSize)), held = clamp(texel, int2(0, 0), uvSize - 1);
    int2 e = exemplarPixel(int2(outputWraps.x ? wrapped.x : held.x, outputWraps.y ? wrapped.y : held.y));
    // The texel's piece goes on as far as p. Exact: texel and p are small numbers, and their difference smaller.
    taps.st[i] = (float2(e) + (p - float2(texel))) / float2(exemplarSize);
    int2 origin = e - texel;
    if (i == 0) first = origin;
    taps.continuous = taps.continuous && all(origin == first);
  }
  return taps;
}

// `texels`: side of what the probe covers, from the derivatives of the output coordinate. Those of the exemplar
// coordinate are no use: it jumps at seams, and a quad of pixels across one would take the coarsest mip.
ExemplarPlace placeInExemplar(float2 st, float texels) {
  float lod = max(log2(max(texels, 1e-6)), 0.0);
  ExemplarPlace place = (ExemplarPlace)0;
  place.level = int(lod);
  place.blend = lod - float(place.level);
  place.st = st;
  place.farLod = lod - float(farLevel);
  float2 inside = float2(outputWraps.x ? frac(st.x) : st.x, outputWraps.y ? frac(st.y) : st.y);
  if (place.level < farLevel) place.fine = exemplarTaps(inside * float2(uvSize), place.level);
  if (place.blend > 0.0 && place.level + 1 < farLevel)
    place.coarse = exemplarTaps(inside * float2(uvSize), place.level + 1);
  return place;
}

float4 sampleTaps(Texture2D<float4> exemplar, ExemplarTaps taps) {
  float4 value = exemplar.SampleLevel(exemplarSampler, taps.st[0], taps.level);
  if (taps.continuous) return value;
  value *= taps.weights.x;
  value += taps.weights.y * exemplar.SampleLevel(exemplarSampler, taps.st[1], taps.level);
  value += taps.weights.z * exemplar.SampleLevel(exemplarSampler, taps.st[2], taps.level);
  value += taps.weights.w * exemplar.SampleLevel(exemplarSampler, taps.st[3], taps.level);
  return value;
}

// `exemplar`: a map with mips. `farMap`: the same map resolved, from level farLevel on. Colours in sRGB textures are
// blended linearly. Normals come back shortened where they differ: normalize them.
float4 sampleExemplar(Texture2D<float4> exemplar, Texture2D<float4> farMap, ExemplarPlace place) {
  if (place.level >= farLevel) return farMap.SampleLevel(farSampler, place.st, place.farLod);
  float4 fine = sampleTaps(exemplar, place.fine);
  if (place.blend == 0.0) return fine;
  float4 coarse;
  if (place.level + 1 < farLevel) coarse = sampleTaps(exemplar, place.coarse);
  else coarse = farMap.SampleLevel(farSampler, place.st, 0.0);
  return lerp(fine, coarse, place.blend);
}

// From the derivatives of the output coordinate in texels. With more than one probe, surfaces seen at an angle stay
// sharp: take the mean of sampleExemplar over
//   placeInExemplar(st + (float(i) - 0.5 * float(f.probes - 1)) * f.step / uvSize, f.texels)   for i from 0 to f.probes - 1.
ExemplarFootprint exemplarFootprint(float2 dx, float2 dy, int mostProbes) {
  float a = length(dx), b = length(dy);
  float2 major = a > b ? dx : dy;
  float longer = max(a, b), shorter = min(a, b);
  ExemplarFootprint f;
  f.probes = clamp(int(ceil(longer / max(shorter, 1.0) - 0.01)), 1, mostProbes);
  f.texels = longer / float(f.probes);
  f.step = major / float(f.probes);
  return f;
}
