// Charts: their colours, keys and legends, and figures that follow each other.
const INK = "#2b2f36";

function recolor(plots) {
  const on = dark.matches, ink = on ? "#e4e7eb" : INK, soft = on ? "#3a414b" : "#dfe3e8", grey = on ? "#b5bcc5" : "#5d5d5d";
  for (const plot of plots) {
    plot.title.text_color = ink;
    for (const part of [...plot.above, ...plot.below, ...plot.left, ...plot.right]) {
      if ("major_label_text_color" in part) {
        Object.assign(part, { axis_label_text_color: ink, major_label_text_color: ink, axis_line_color: ink, major_tick_line_color: ink,
          minor_tick_line_color: null });
      }
      if ("label_text_color" in part) part.label_text_color = ink;
    }
    for (const part of plot.center) {
      if ("grid_line_color" in part) part.grid_line_color = soft;
      if (part.type === "Span" && [INK, "#e4e7eb"].includes(part.line_color)) part.line_color = ink;
      if (part.type === "Label" && ["#000000", INK, "#e4e7eb"].includes(part.text_color)) part.text_color = ink;
    }
    for (const { glyph } of plot.renderers.filter((one) => "glyph" in one)) {
      const before = glyph.line_color?.value;
      if ([INK, "#e4e7eb"].includes(before)) glyph.line_color = { value: ink };
      if (["#5d5d5d", "#b5bcc5"].includes(before)) glyph.line_color = { value: grey };
    }
  }
}

function link(plots) {
  const kind = ({ tags, x_range }) => [tags[0], x_range.start.toPrecision(6), x_range.end.toPrecision(6)].join();
  const kinds = new Map(plots.map((plot) => [plot, kind(plot)]));
  for (const plot of plots) {
    const range = plot.x_range;
    const follow = () => {
      for (const other of plots) {
        if (other === plot || kinds.get(other) !== kinds.get(plot)) continue;
        if (other.x_range.start !== range.start || other.x_range.end !== range.end) {
          other.x_range.setv({ start: range.start, end: range.end });
        }
      }
    };
    range.properties.start.change.connect(follow);
    range.properties.end.change.connect(follow);
  }
}

function steer(box, plot) {
  const range = plot.x_range, all = [range.start, range.end], heights = [plot.y_range.start, plot.y_range.end];
  box.addEventListener("keydown", (event) => {
    const size = range.end - range.start, middle = (range.start + range.end) / 2;
    const zoom = (factor) => [middle - 0.5 * factor * size, middle + 0.5 * factor * size];
    const wanted = { ArrowLeft: [range.start - 0.1 * size, range.end - 0.1 * size], ArrowRight: [range.start + 0.1 * size, range.end + 0.1 * size],
      "+": zoom(0.7), "=": zoom(0.7), "-": zoom(1 / 0.7), 0: all }[event.key];
    if (!wanted) return;
    range.setv({ start: wanted[0], end: wanted[1] });
    if (event.key === "0") plot.y_range.setv({ start: heights[0], end: heights[1] });
    event.preventDefault();
  });
}

function fold(box, plot) {
  const legends = plot.above.filter((part) => "ncols" in part);
  new ResizeObserver(() => {
    for (const legend of legends) {
      const longest = Math.max(...legend.items.map((item) => (item.label?.value ?? "").length));
      legend.ncols = Math.max(1, Math.floor(box.clientWidth / (46 + 7 * longest)));
    }
  }).observe(box);
}

async function showCharts(content) {
  await Bokeh.embed.embed_items(content.documents, content.items);
  const plots = [];
  const places = content.items[0].roots;
  for (const plot of Bokeh.documents.flatMap((one) => one.roots())) {
    if (!(plot.id in places)) continue;
    plots.push(plot);
    const box = document.getElementById(places[plot.id]);
    steer(box, plot);
    fold(box, plot);
  }
  recolor(plots);
  link(plots);
  dark.addEventListener("change", () => recolor(plots));
  document.documentElement.dataset.charts = plots.length;
}
