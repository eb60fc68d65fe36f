#!/usr/bin/env bash
# three's USDLoader turns textures the other way, and takes no notice of sourceColorSpace.
#
# Version:   three 0.187.0 (npm)
# Guess:     UsdTransform2d is applied as USD defines it: scaled, then turned counter-clockwise, then moved. Base colour that
#            is marked raw is used as it is.
# Behaviour: it is turned clockwise, and scaled after that, so with unequal scales even the shape differs: of (1, 0), turned by
#            90 degrees and scaled by (2, 4), comes (0, -4) in place of (0, 2). Repeats and offsets alone are right. Base
#            colour is always decoded as sRGB, whether it says raw, sRGB, auto or nothing.
# Matters:   wood grain and brick courses that are turned in the document run the wrong way on the web; a colour chart or a
#            linear picture comes out dark. Turn the texture coordinates of the mesh, and write 8-bit sRGB.
# Seen on 2026-11-27:
#   (1, 0) without a turn: 2 0
#   (1, 0) turned by 90 degrees: 0 -4
#   (0, 1) turned by 90 degrees: 2 0
#   spaces of raw, sRGB, auto, none: srgb srgb srgb srgb
. "$(dirname "$0")/common/packages.bash"
node_packages three@0.187.0

cat >read.mjs <<'JS'
// Pictures "load" at once; they have no pixels.
const picture = () => ({
  style: {}, removeEventListener() {},
  addEventListener(type, done) { if (type === 'load') queueMicrotask(() => done.call(this)); },
});
Object.assign(globalThis, {self: globalThis, document: {createElementNS: picture}});
const {Vector2} = await import('three');
const {USDLoader} = await import('three/addons/loaders/USDLoader.js');
const document = (turn, space) => `#usda 1.0
(
    defaultPrim = "Wall"
    upAxis = "Y"
)

def Xform "Wall"
{
    def Mesh "Plane" (
        prepend apiSchemas = ["MaterialBindingAPI"]
    )
    {
        int[] faceVertexCounts = [3]
        int[] faceVertexIndices = [0, 1, 2]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
        texCoord2f[] primvars:st = [(0, 0), (1, 0), (0, 1)] (
            interpolation = "vertex"
        )
        rel material:binding = </Wall/Stone>
    }

    def Material "Stone"
    {
        token outputs:surface.connect = </Wall/Stone/Surface.outputs:surface>

        def Shader "Surface"
        {
            uniform token info:id = "UsdPreviewSurface"
            color3f inputs:diffuseColor.connect = </Wall/Stone/Colour.outputs:rgb>
            token outputs:surface
        }

        def Shader "Colour"
        {
            uniform token info:id = "UsdUVTexture"
            asset inputs:file = @colour.png@
            float2 inputs:st.connect = </Wall/Stone/Turn.outputs:result>
            ${space ? `token inputs:sourceColorSpace = "${space}"` : ''}
            float3 outputs:rgb
        }

        def Shader "Turn"
        {
            uniform token info:id = "UsdTransform2d"
            float2 inputs:in.connect = </Wall/Stone/Coordinates.outputs:result>
            float inputs:rotation = ${turn}
            float2 inputs:scale = (2, 4)
            float2 outputs:result
        }

        def Shader "Coordinates"
        {
            uniform token info:id = "UsdPrimvarReader_float2"
            string inputs:varname = "st"
            float2 outputs:result
        }
    }
}
`;
async function texture(turn, space) {
  let found;
  new USDLoader().parse(document(turn, space), 'folder/').traverse(part => { found ??= part.material?.map; });
  await new Promise(done => setTimeout(done, 20));
  found.updateMatrix();
  return found;
}
const placed = async (turn, s, t) =>
  new Vector2(s, t).applyMatrix3((await texture(turn)).matrix).toArray().map(v => Math.round(v) + 0).join(' ');
console.log(await placed(0, 1, 0));
console.log(await placed(90, 1, 0));
console.log(await placed(90, 0, 1));
const spaces = [];
for (const space of ['raw', 'sRGB', 'auto', '']) spaces.push((await texture(0, space)).colorSpace);
console.log(...spaces);
JS
node read.mjs >said 2>&1
expect "(1, 0) without a turn" "$(sed -n 1p said)" "2 0"
expect "(1, 0) turned by 90 degrees" "$(sed -n 2p said)" "0 -4"
expect "(0, 1) turned by 90 degrees" "$(sed -n 3p said)" "2 0"
expect "spaces of raw, sRGB, auto, none" "$(sed -n 4p said)" "srgb srgb srgb srgb"
finish
