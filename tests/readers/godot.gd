# The preset `godot` as Godot 3 shows it, seen from above under the light of preview.
# Usage, in an X server and in the exports' folder: godot3 --video-driver GLES3 --script godot.gd JOBS: a file with a line
# for each picture: the files' path up to the suffix, how often the maps are repeated, the side in pixels, the picture.
extends SceneTree

const AZIMUTH = 135
const ELEVATION = 40
const AMBIENT = 0.25


func texture(path):
	var image = Image.new()
	if image.load(path) != OK:
		printerr("WRONG: " + path + " cannot be read")
	image.convert(Image.FORMAT_RGB8)
	var made = ImageTexture.new()
	# Colours are told from data by their use, as in imported files.
	made.create_from_image(image, Texture.FLAG_FILTER | Texture.FLAG_REPEAT | (Texture.FLAG_CONVERT_TO_LINEAR if path.ends_with("_albedo.png") else 0))
	return made


func show(path, repeats, side, picture):
	var view = Viewport.new()
	view.size = Vector2(side, side)
	view.own_world = true
	view.render_target_update_mode = Viewport.UPDATE_ALWAYS
	view.render_target_v_flip = true
	view.hdr = true
	root.add_child(view)

	var plane = MeshInstance.new()
	plane.mesh = PlaneMesh.new()
	plane.mesh.size = Vector2(1, 1)
	var material = SpatialMaterial.new()
	material.albedo_texture = texture(path + "_albedo.png")
	material.normal_enabled = true
	material.normal_texture = texture(path + "_normal.png")
	# What ORMMaterial3D of Godot 4 takes by itself.
	var orm = texture(path + "_orm.png")
	material.ao_enabled = true
	material.ao_texture = orm
	material.ao_texture_channel = SpatialMaterial.TEXTURE_CHANNEL_RED
	material.roughness_texture = orm
	material.roughness_texture_channel = SpatialMaterial.TEXTURE_CHANNEL_GREEN
	material.roughness = 1
	material.metallic_texture = orm
	material.metallic_texture_channel = SpatialMaterial.TEXTURE_CHANNEL_BLUE
	material.metallic = 1
	material.uv1_scale = Vector3(repeats, repeats, 1)
	plane.mesh.material = material
	view.add_child(plane)

	# The plane lies on the ground: the picture's up is -z.
	var flat = cos(deg2rad(ELEVATION))
	var light = DirectionalLight.new()
	var from = Vector3(flat * cos(deg2rad(AZIMUTH)), sin(deg2rad(ELEVATION)), -flat * sin(deg2rad(AZIMUTH)))
	light.light_specular = 1
	view.add_child(light)
	light.look_at_from_position(from, Vector3(), Vector3.UP)

	var camera = Camera.new()
	camera.projection = Camera.PROJECTION_ORTHOGONAL
	camera.size = 1
	camera.environment = Environment.new()
	# Only a sky is mirrored.
	var sky = ProceduralSky.new()
	for part in ["sky_top_color", "sky_horizon_color", "ground_bottom_color", "ground_horizon_color"]:
		sky.set(part, Color(1, 1, 1))
	sky.sun_energy = 0
	camera.environment.background_mode = Environment.BG_SKY
	camera.environment.background_sky = sky
	camera.environment.background_energy = 0.8 * AMBIENT
	view.add_child(camera)
	camera.look_at_from_position(Vector3(0, 2, 0), Vector3(), Vector3(0, 0, -1))
	camera.current = true
	for frame in 10:
		yield(self, "idle_frame")
	view.get_texture().get_data().save_png(picture)
	view.queue_free()


func _initialize():
	var file = File.new()
	file.open(OS.get_cmdline_args()[-1], File.READ)
	for line in file.get_as_text().strip_edges().split("\n"):
		var words = line.split(" ")
		yield(show(words[0], float(words[1]), int(words[2]), words[3]), "completed")
	quit()
