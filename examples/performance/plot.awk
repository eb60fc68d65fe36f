# Draws rows of "x,seconds,MiB" as an SVG of two panels: CPU seconds and peak memory. Variables: title, label (of the
# horizontal axes), scale ("log": both axes logarithmic; "linear": both from 0).
BEGIN { FS = ","; width = 360; height = 260; left = 70; top = 46; gap = 90 }
{ count++; x[count] = $1; value[1, count] = $2; value[2, count] = $3 }

function position(v, low, high) {
  return scale == "log" ? log(v / low) / log(high / low) : (v - low) / (high - low)
}

# A round number near v.
function nice(v,    power) {
  power = exp(int(log(v) / log(10) - (v < 1)) * log(10))
  return v / power < 1.5 ? power : v / power < 3.5 ? 2 * power : v / power < 7.5 ? 5 * power : 10 * power
}

function shown(v) { return sprintf(v < 100 ? "%.2g" : "%.0f", v) }

function text(px, py, anchor, size, what) {
  printf "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" font-size=\"%d\">%s</text>\n", px, py, anchor, size, what
}

function tick(panel, v, low, high,    y) {
  y = top + height * (1 - position(v, low, high))
  printf "<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%.1f\" y2=\"%.1f\" stroke=\"#ddd\"/>\n", origin, origin + width, y, y
  text(origin - 6, y + 4, "end", 12, shown(v))
}

function panel(number, what, color,    i, low, high, from, to, px, py, path, v, step) {
  origin = left + (number - 1) * (width + gap)
  low = high = value[number, 1]
  for (i = 2; i <= count; i++) {
    if (value[number, i] < low) low = value[number, i]
    if (value[number, i] > high) high = value[number, i]
  }
  if (scale == "log") {
    low /= 1.5; high *= 1.5; from = x[1] / 1.2; to = x[count] * 1.2
    for (v = exp(int(log(low) / log(10) - 1) * log(10)); v <= high; v *= 10)
      for (i = 1; i <= 5; i += (i == 1) ? 1 : 3) if (v * i >= low && v * i <= high) tick(number, v * i, low, high)
  } else {
    low = 0; high *= 1.15; from = 0; to = x[count] * 1.1
    step = nice(high / 5)
    for (v = 0; v <= high; v += step) tick(number, v, low, high)
  }
  printf "<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" fill=\"none\" stroke=\"#888\"/>\n", origin, top, width, height
  for (i = 1; i <= count; i++) {
    px = origin + width * position(x[i], from, to)
    py = top + height * (1 - position(value[number, i], low, high))
    path = path sprintf("%s%.1f,%.1f", i > 1 ? " " : "", px, py)
    printf "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"%s\"/>\n", px, py, color
    text(px, py - 9, "middle", 11, shown(value[number, i]))
    text(px, top + height + 18, "middle", 12, x[i])
  }
  printf "<polyline points=\"%s\" fill=\"none\" stroke=\"%s\" stroke-width=\"2\"/>\n", path, color
  text(origin + width / 2, top + height + 38, "middle", 13, label)
  text(origin, top - 8, "start", 13, what)
}

END {
  printf "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" font-family=\"sans-serif\">\n", left + 2 * width + gap + 30, top + height + 54
  print "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>"
  text(left, 20, "start", 16, title)
  panel(1, "CPU seconds, whole process", "#1f6fb4")
  panel(2, "peak memory, MiB", "#c0561f")
  print "</svg>"
}
