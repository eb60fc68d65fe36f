// What engines make of the channels of packed maps, as their documentation has it (none of this comes from terrazzo):
// surface: occlusion, roughness and metallic from the packed file; vector: its normals with green up.
//   Unreal Engine, "Physically Based Materials" and "Texture Masking": occlusion, roughness and metallic in red, green
//     and blue; normal maps as DirectX has them, green down.
//   Unity, "Mask and detail maps" (HDRP): metallic, occlusion, detail mask, smoothness; "Lit Shader" (URP): metallic in
//     red and smoothness in alpha of the metallic map, occlusion in green of the occlusion map; green up.
//   Godot, ORMMaterial3D: occlusion, roughness, metallic; BaseMaterial3D: normals as OpenGL has them, green up.
export const engines = {
  unreal: {colour: '_BaseColor', packed: '_ORM', normal: '_Normal', surface: 'packed.rgb', vector: 'vec3(normal.r, 1.0 - normal.g, normal.b)'},
  unity_hdrp: {colour: '_BaseColor', packed: '_MaskMap', normal: '_Normal', surface: 'vec3(packed.g, 1.0 - packed.a, packed.r)',
               vector: 'normal.rgb'},
  unity_urp: {colour: '_BaseMap', packed: '_MetallicOcclusionSmoothness', normal: '_Normal',
              surface: 'vec3(packed.g, 1.0 - packed.a, packed.r)', vector: 'normal.rgb'},
  godot: {colour: '_albedo', packed: '_orm', normal: '_normal', surface: 'packed.rgb', vector: 'normal.rgb'},
};
