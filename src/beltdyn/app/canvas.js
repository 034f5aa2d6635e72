// The canvas of the page: an SVG in millimetres, y down. Python gives the scene; this file draws it, and tells of drags
// and keys. While something is dragged the browser draws it where the pointer is, and the rest follows from Python.

const NICE = [1, 2, 5, 10];

function niceStep(length) {
  const power = 10 ** Math.floor(Math.log10(length));
  return power * NICE.find((one) => one * power >= length * 0.999);
}

export default {
  template: `
   <div>
    <div v-if="lost" class="bd-lost" role="alert">
      The server has stopped. Restart it: beltdyn app.
      <a :href="kept" :download="name">Keep the drive file</a>
    </div>
    <svg ref="svg" :class="['bd-canvas', { 'bd-watching': live }]" role="application" :viewBox="viewBox" preserveAspectRatio="xMidYMid meet"
         :aria-label="'Layout of the drive with ' + pulleys.length + ' pulleys. Tab reaches each pulley.'"
         @pointerdown="down($event, null)" @pointermove="moved" @pointerup="up" @pointercancel="up"
         @wheel.prevent="wheel" @dblclick="add">
      <path class="bd-grid" :d="grid" />
      <path class="bd-axis" :d="axes" />
      <path v-if="shown.rest" class="bd-rest" :d="shown.rest" />
      <circle v-for="(one, i) in shown.ghosts || []" :key="'g' + i" class="bd-ghost" :cx="one.x" :cy="one.y" :r="one.r" />
      <path v-if="shown.belt" :class="shown.valid ? 'bd-belt' : 'bd-belt bd-sketch'" :d="shown.belt"
            :stroke-width="Math.max(shown.thickness || 0, 3 * px)" />
      <path v-for="(one, i) in pulled" :key="'p' + i" class="bd-pulled" :d="one.d" :stroke-width="one.width" />
      <g v-if="live" class="bd-live">
        <g v-for="(one, i) in live.pulleys" :key="'lp' + i">
          <circle class="bd-rim" :cx="one.x" :cy="one.y" :r="one.r" />
          <path class="bd-spoke" :d="spokes(one)" />
        </g>
        <path v-for="(one, i) in live.belt" :key="'lb' + i" :d="one.d" :stroke="one.color" fill="none" stroke-linecap="round"
              :stroke-width="Math.max(shown.thickness || 0, 4 * px)" />
      </g>
      <g v-for="one in shown.tensioners || []" :key="'t' + one.number" class="bd-tensioner">
        <template v-if="one.pivot">
          <path class="bd-arm" :d="'M' + at('pivot', one).join(' ') + 'L' + one.x + ' ' + one.y" />
          <circle class="bd-handle" :cx="at('pivot', one)[0]" :cy="at('pivot', one)[1]" :r="6 * px" tabindex="0" role="button"
                  :aria-label="'pivot of tensioner ' + (one.number + 1) + ', arrow keys move it'"
                  @pointerdown.stop="down($event, { kind: 'pivot', number: one.number, from: one.pivot })"
                  @keydown="pivotKey($event, one)" />
        </template>
        <template v-if="one.direction">
          <path class="bd-arm" :d="arrow(one)" />
          <circle class="bd-handle" :cx="tip(one)[0]" :cy="tip(one)[1]" :r="5 * px"
                  @pointerdown.stop="down($event, { kind: 'direction', number: one.number, from: tip(one) })" />
        </template>
      </g>
      <g v-for="one in pulleys" :key="one.number" tabindex="0" role="button" :data-pulley="one.name"
         :class="['bd-pulley', { 'bd-chosen': one.number === selected, 'bd-back': one.outside, 'bd-wrong': one.wrong }]"
         :aria-label="spoken(one)" :aria-pressed="one.number === selected"
         @pointerdown.stop="down($event, { kind: 'move', number: one.number, from: [one.x, one.y] })"
         @focus="choose(one.number)" @keydown="key($event, one)">
        <circle class="bd-rim" :cx="one.x" :cy="one.y" :r="one.r" />
        <circle v-if="one.outside" class="bd-inner" :cx="one.x" :cy="one.y" :r="0.82 * one.r" />
        <circle v-if="one.drives" class="bd-drives" :cx="one.x" :cy="one.y" :r="Math.min(0.3 * one.r, 9 * px)" />
        <path v-else class="bd-hub" :d="cross(one)" />
        <path v-if="one.sense && one.r > 38 * px" class="bd-turns" :d="turning(one)" />
        <text :transform="put(...named(one, -1))" font-size="13" :text-anchor="side(one)">{{ one.name }}</text>
        <text class="bd-small" :transform="put(...named(one, 1))" font-size="11" :text-anchor="side(one)">{{ one.wrap }}</text>
      </g>
      <text v-for="(one, i) in roomy" :key="'s' + i" class="bd-small bd-span" font-size="11" :text-anchor="anchor(one)"
            :transform="put(one.x + one.right * away(one), one.y + one.down * away(one) + 4 * px)">{{ written(one.length) }}</text>
      <text v-for="(one, i) in pulled" :key="'n' + i" :class="['bd-small', 'bd-span', 'bd-pull', { 'bd-side': one.side }]"
            :transform="put(one.x, one.y)" font-size="11" :text-anchor="one.anchor">{{ one.label }}</text>
      <rect v-for="(end, i) in shown.ends || []" :key="'e' + i" class="bd-end" :x="end[0] - 5 * px" :y="end[1] - 5 * px"
            :width="10 * px" :height="10 * px" />
      <circle v-if="chosen" class="bd-handle bd-size" :cx="chosen.x + 0.7071 * chosen.r" :cy="chosen.y + 0.7071 * chosen.r"
              :r="6 * px" @pointerdown.stop="down($event, { kind: 'size', number: chosen.number, from: null })">
        <title>drag to size</title>
      </circle>
      <text v-for="(one, i) in numbers" :key="'gn' + i" class="bd-small bd-of-grid" :transform="put(one.x, one.y)" font-size="10"
            :text-anchor="one.anchor" aria-hidden="true">{{ one.text }}</text>
      <g class="bd-scale" aria-hidden="true">
        <path :d="scale.line" />
        <text :transform="put(scale.x, scale.y - 5 * px)" font-size="11" text-anchor="middle">{{ scale.label }}</text>
      </g>
      <text v-if="pulleys.length === 0" class="bd-hint" :transform="put(view.x + view.w / 2, view.y + view.h / 2)" font-size="16"
            text-anchor="middle">Double-click to place a pulley</text>
    </svg>
   </div>`,
  props: { scene: Object, live: Object, tensions: Array, unit: Object, selected: Number, text: String, name: String },
  data: () => ({
    view: { x: -250, y: -150, w: 500, h: 300 },
    size: { w: 800, h: 450 },
    drag: null, // what is dragged, and where it is
    followed: null, // the scene while something is dragged
    waiting: false, // Python has been asked, and has not answered yet
    fitted: true,
    lost: false, // the server does not answer any more
  }),
  computed: {
    shown() {
      return this.followed || this.scene;
    },
    kept() {
      return "data:text/plain;charset=utf-8," + encodeURIComponent(this.text || "");
    },
    px() {
      return Math.max(this.view.w / this.size.w, this.view.h / this.size.h);
    },
    viewBox() {
      return [this.view.x, this.view.y, this.view.w, this.view.h].join(" ");
    },
    pulleys() {
      return (this.shown.pulleys || []).map((one) => {
        if (!this.drag || this.drag.number !== one.number || !this.drag.to) return one;
        if (this.drag.kind === "move") return { ...one, x: this.drag.to[0], y: this.drag.to[1] };
        if (this.drag.kind === "size") return { ...one, r: this.drag.radius };
        return one;
      });
    },
    chosen() {
      return this.pulleys.find((one) => one.number === this.selected);
    },
    snap() {
      return niceStep(this.px);
    },
    grid() {
      const step = niceStep(50 * this.px);
      const lines = [];
      for (let x = Math.ceil(this.view.x / step) * step; x < this.view.x + this.view.w; x += step)
        lines.push(`M${x} ${this.view.y}v${this.view.h}`);
      for (let y = Math.ceil(this.view.y / step) * step; y < this.view.y + this.view.h; y += step)
        lines.push(`M${this.view.x} ${y}h${this.view.w}`);
      return lines.join("");
    },
    scale() { // a cell of the grid, in the lower left corner
      const step = niceStep(50 * this.px);
      const [left, y] = [this.view.x + 14 * this.px, this.view.y + this.view.h - 12 * this.px];
      const label = `${Number((step / this.measure.size).toPrecision(3))} ${this.measure.name}`;
      const end = 4 * this.px;
      return { line: `M${left} ${y - end}v${2 * end}M${left} ${y}h${step}m0 ${-end}v${2 * end}`, x: left + step / 2, y, label };
    },
    measure() {
      return this.unit || { name: "mm", size: 1 };
    },
    pulled() { // tensions of spans beside their lengths: lines as wide as the tensions are large
      const spans = this.shown.spans || [], known = this.tensions || [];
      if (this.live || !this.shown.valid || known.length !== spans.length || known.length === 0) return [];
      const [least, most] = [Math.min(...known), Math.max(...known)];
      if (most - least < 0.02 * Math.abs(most)) return []; // at rest all are alike
      return spans.map((one, i) => {
        const share = Math.max(known[i], 0) / most;
        const side = known[i] === most ? "tight " : known[i] === least ? "slack " : "";
        const away = this.away(one), [x1, y1, x2, y2] = one.ends;
        return {
          d: `M${x1} ${y1}L${x2} ${y2}`, width: Math.max(8 * share, 0.75) * this.px, side,
          x: one.x + one.right * away, y: one.y + one.down * away + (one.down < -0.3 ? -9 : 17) * this.px,
          anchor: this.anchor(one), label: `${side}${Number(known[i].toPrecision(3))} N`,
        };
      });
    },
    roomy() { // spans that are long enough for their lengths
      return (this.shown.spans || []).filter((one) => one.length > 70 * this.px);
    },
    numbers() { // of the grid, along the lower and the left edge
      const step = niceStep(50 * this.px) * 2, found = [];
      const name = (at) => String(Number((at / this.measure.size).toPrecision(6)));
      const room = 70 * this.px;
      for (let x = Math.ceil((this.view.x + 2.2 * room) / step) * step; x < this.view.x + this.view.w - room / 2; x += step)
        found.push({ x, y: this.view.y + this.view.h - 5 * this.px, text: name(x), anchor: "middle" });
      for (let y = Math.ceil((this.view.y + room / 3) / step) * step; y < this.view.y + this.view.h - room / 1.5; y += step)
        found.push({ x: this.view.x + 5 * this.px, y: y + 3.5 * this.px, text: name(-y || 0), anchor: "start" });
      return found;
    },
    axes() {
      return `M0 ${this.view.y}v${this.view.h}M${this.view.x} 0h${this.view.w}`;
    },
  },
  watch: {
    scene() {
      if (this.fitted && !this.drag && !this.fits()) this.fit();
    },
  },
  mounted() {
    this.observer = new ResizeObserver(() => {
      const box = this.$refs.svg.getBoundingClientRect();
      if (box.width > 0 && box.height > 0) this.size = { w: box.width, h: box.height };
      this.fit();
    });
    this.observer.observe(this.$refs.svg);
    this.asking = setInterval(() => {
      const silent = window.socket !== undefined && !window.socket.connected;
      this.lost = silent && this.silent; // twice in a row
      this.silent = silent;
    }, 1500);
    this.fit();
  },
  unmounted() {
    this.observer.disconnect();
    clearInterval(this.asking);
  },
  methods: {
    follow(scene) { // Python calls it while something is dragged, which spares Vue the rest of the page; null ends it
      this.followed = scene;
      this.waiting = false;
      this.ask();
    },
    fit() {
      const [left, top, right, bottom] = this.shown.extent || [-250, -150, 250, 150];
      const aspect = this.size.w / this.size.h;
      const width = Math.max(right - left, (bottom - top) * aspect) * 1.25;
      const height = width / aspect;
      this.view = { x: (left + right - width) / 2, y: (top + bottom - height) / 2, w: width, h: height };
      this.fitted = true;
    },
    fits() {
      const [left, top, right, bottom] = this.shown.extent;
      const { x, y, w, h } = this.view;
      const inside = left >= x && top >= y && right <= x + w && bottom <= y + h;
      return inside && Math.max((right - left) / w, (bottom - top) / h) > 0.5;
    },
    world(event) {
      const svg = this.$refs.svg;
      const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
      return [point.x, point.y];
    },
    snapped(point) {
      return point.map((one) => Math.round(one / this.snap) * this.snap);
    },
    turning(one) { // an arc with an arrowhead along the top of the rim; y is down
      const r = 0.86 * one.r, open = 0.5, head = Math.min(6 * this.px, 0.2 * one.r);
      const at = (angle) => [one.x + r * Math.sin(angle), one.y - r * Math.cos(angle)];
      const [from, to] = [at(one.sense * open), at(-one.sense * open)];
      const along = [-one.sense * Math.cos(open), Math.sin(open)];
      const barb = (side) => [to[0] - head * (along[0] + side * along[1]), to[1] - head * (along[1] - side * along[0])];
      const arc = `M${from.join(" ")}A${r} ${r} 0 0 ${one.sense > 0 ? 0 : 1} ${to.join(" ")}`;
      return `${arc}M${barb(0.6).join(" ")}L${to.join(" ")}L${barb(-0.6).join(" ")}`;
    },
    written(length) {
      const { name, size } = this.measure;
      return `${(length / size).toFixed(size === 1 ? 1 : 4)} ${name}`;
    },
    at(kind, one) {
      const dragged = this.drag && this.drag.kind === kind && this.drag.number === one.number && this.drag.to;
      return dragged ? this.drag.to : one[kind];
    },
    tip(one) {
      if (this.drag && this.drag.kind === "direction" && this.drag.number === one.number && this.drag.to) return this.drag.to;
      const carried = this.pulleys.find((each) => Math.abs(each.x - one.x) < 1e-6 && Math.abs(each.y - one.y) < 1e-6);
      const far = (carried ? carried.r : 0) + 30 * this.px;
      return [one.x + far * one.direction[0], one.y + far * one.direction[1]];
    },
    arrow(one) {
      const [x, y] = this.tip(one);
      return `M${one.x} ${one.y}L${x} ${y}`;
    },
    put(x, y) { // texts keep their size: browsers draw no font larger than 10000, which the units of a long drive exceed
      return `translate(${x} ${y}) scale(${this.px})`;
    },
    beside(one) { // where the name of a small pulley has room: beyond its belt, and beside the handle of a tensioner
      if (!one.beyond || one.r > 22 * this.px) return null;
      const pulled = (this.shown.tensioners || []).some((each) => each.direction && Math.hypot(each.x - one.x, each.y - one.y) < 1e-6);
      const level = Math.abs(one.beyond[0]) > 0.7;
      return { right: one.beyond[0], down: one.beyond[1], level, shift: pulled ? [level ? 0 : 12, level ? 18 : 0] : [0, 0] };
    },
    named(one, line) { // of its name (-1) and its wrap angle (1)
      const found = this.beside(one), px = this.px;
      if (!found) return [one.x, one.y + line * Math.min(0.35 * one.r, 12 * px) + (line > 0 ? 9 * px : 0)];
      const far = one.r + (12 + 12 * Math.abs(found.down)) * px;
      return [one.x + found.right * far + found.shift[0] * px, one.y + found.down * far + (found.shift[1] + (line > 0 ? 12 : -2)) * px];
    },
    side(one) {
      const found = this.beside(one);
      if (!found) return "middle";
      if (found.level) return found.right > 0 ? "start" : "end";
      return found.shift[0] ? "start" : "middle";
    },
    away(one) { // of a length from its span
      return (this.anchor(one) === "middle" ? 14 + 20 * Math.abs(one.right) : 12) * this.px;
    },
    anchor(one) { // beside an upright span the text begins or ends
      return Math.abs(one.right) < 0.5 ? "middle" : one.right > 0 ? "start" : "end";
    },
    spokes(one) {
      return [0, 120, 240].map((more) => {
        const angle = ((one.angle + more) * Math.PI) / 180;
        const [x, y] = [one.r * Math.cos(angle), one.r * Math.sin(angle)];
        return `M${one.x + 0.3 * x} ${one.y + 0.3 * y}L${one.x + 0.85 * x} ${one.y + 0.85 * y}`;
      }).join("");
    },
    cross(one) {
      const a = Math.min(0.15 * one.r, 6 * this.px);
      return `M${one.x - a} ${one.y}h${2 * a}M${one.x} ${one.y - a}v${2 * a}`;
    },
    spoken(one) {
      const side = one.outside ? "on the back of the belt" : "on the inside of the belt";
      const wrap = one.wrap ? `, wrapped by ${one.wrap}` : "";
      return `${one.name}, radius ${this.written(one.r)}, ${side}${wrap}. Arrow keys move, plus and minus size, B turns it to the other side, Delete removes.`;
    },
    choose(number) {
      if (number !== this.selected) this.$emit("choose", { number });
    },
    down(event, what) {
      if (event.button !== 0) return;
      this.$refs.svg.setPointerCapture(event.pointerId);
      const start = this.world(event);
      if (what === null) {
        this.drag = { kind: "pan", start: [event.clientX, event.clientY], view: { ...this.view }, moved: false };
        return;
      }
      if (what.kind === "move") this.$emit("choose", { number: what.number });
      const offset = what.from ? [what.from[0] - start[0], what.from[1] - start[1]] : [0, 0];
      this.drag = { ...what, start, offset, to: null, radius: 0, moved: false };
      if (what.kind === "move" && event.currentTarget.focus) event.currentTarget.focus({ preventScroll: true });
    },
    moved(event) {
      const drag = this.drag;
      if (!drag) return;
      if (drag.kind === "pan") {
        const [dx, dy] = [event.clientX - drag.start[0], event.clientY - drag.start[1]];
        if (Math.hypot(dx, dy) < 4) return;
        drag.moved = true;
        this.fitted = false;
        this.view = { ...drag.view, x: drag.view.x - dx * this.px, y: drag.view.y - dy * this.px };
        return;
      }
      const here = this.world(event);
      if (!drag.moved && Math.hypot(here[0] - drag.start[0], here[1] - drag.start[1]) < 3 * this.px) return;
      drag.moved = true;
      drag.to = this.snapped([here[0] + drag.offset[0], here[1] + drag.offset[1]]);
      if (drag.kind === "size") {
        const one = this.shown.pulleys.find((each) => each.number === drag.number);
        const away = Math.hypot(here[0] - one.x, here[1] - one.y);
        drag.radius = Math.max(Math.round(away / this.snap) * this.snap, this.snap);
      }
      drag.pending = true;
      this.ask();
    },
    ask() {
      if (!this.drag || !this.drag.pending || this.waiting) return;
      this.drag.pending = false;
      this.waiting = true;
      setTimeout(() => (this.waiting = false), 400);
      this.tell(false);
    },
    up() {
      const drag = this.drag;
      if (!drag) return;
      if (drag.kind !== "pan" && drag.moved) this.tell(true);
      if (drag.kind === "pan" && !drag.moved) this.$emit("choose", { number: null });
      if (drag.kind === "pan" || !drag.moved) this.drag = null;
      else setTimeout(() => (this.drag = null), 150); // Python's answer comes within this time, and nothing jumps back
    },
    tell(done) {
      const { kind, number, to, radius } = this.drag;
      this.$emit("act", { action: kind, number, x: to[0] / 1000, y: -to[1] / 1000, radius: radius / 1000, done });
    },
    act(action, number, more = {}) {
      this.$emit("act", { action, number, done: true, ...more });
    },
    add(event) {
      if (event.target.closest(".bd-pulley, .bd-handle")) return;
      const [x, y] = this.snapped(this.world(event));
      this.act("add", null, { x: x / 1000, y: -y / 1000 });
    },
    step(event) {
      const far = this.snap * (event.shiftKey ? 10 : 1);
      return { ArrowLeft: [-far, 0], ArrowRight: [far, 0], ArrowUp: [0, -far], ArrowDown: [0, far] }[event.key];
    },
    key(event, one) {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      const step = this.step(event);
      const size = { "+": 1, "=": 1, "-": -1 }[event.key];
      if (step) this.act("nudge", one.number, { x: step[0] / 1000, y: -step[1] / 1000 });
      else if (size) this.act("grow", one.number, { radius: (size * this.snap) / 1000 });
      else if (event.key === "b" || event.key === "B") this.act("flip", one.number);
      else if (event.key === "Delete" || event.key === "Backspace") this.act("remove", one.number);
      else return;
      event.preventDefault();
    },
    pivotKey(event, one) {
      const step = this.step(event);
      if (!step) return;
      this.act("nudge_pivot", one.number, { x: step[0] / 1000, y: -step[1] / 1000 });
      event.preventDefault();
    },
    wheel(event) {
      const factor = 1.2 ** Math.sign(event.deltaY);
      if (this.view.w * factor > 1e6 || this.view.w * factor < 1) return;
      const [x, y] = this.world(event);
      this.fitted = false;
      this.view = {
        x: x - (x - this.view.x) * factor, y: y - (y - this.view.y) * factor,
        w: this.view.w * factor, h: this.view.h * factor,
      };
    },
  },
};
