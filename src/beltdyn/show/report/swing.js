// Vibration modes of a drive, animated.

const PERIOD = 1.5; // s, of any mode

class Swing extends Picture {
  constructor(box, data) {
    super(box, data);
    this.phase = 0;
    this.find("chosen", ".mode");
    data.modes.forEach((mode, number) => this.chosen.add(new Option(mode.name, number)));
    this.chosen.onchange = () => this.choose();
    this.choose();
    this.begin();
  }
  choose() {
    const mode = this.data.modes[this.chosen.value], packed = new Uint16Array(bytes(mode.belt).buffer);
    this.mode = { ...mode, belt: Float64Array.from(packed, (one) => this.data.size * (2 * one / 65535 - 1)) };
    this.draw();
  }
  get share() { return this.phase; }
  at(share) { this.phase = share; this.draw(); }
  pass(seconds) { this.phase = (this.phase + seconds / PERIOD) % 1; }
  draw() {
    if (!this.scale) return;
    const pen = this.cleared(), { data, mode } = this, ink = style("--ink"), page = style("--page");
    const angle = 2 * Math.PI * this.phase, [cosine, sine] = [Math.cos(angle), Math.sin(angle)];
    const now = ([real, imaginary]) => real * cosine - imaginary * sine;
    const centers = data.center.map(([x, y], n) => this.to(x + now(mode.center[n][0]), y + now(mode.center[n][1])));
    for (const [x, y, pulley] of data.arms) {
      pen.strokeStyle = ink; pen.lineWidth = 2; pen.globalAlpha = 0.5;
      pen.beginPath(); pen.moveTo(...this.to(x, y)); pen.lineTo(...centers[pulley]); pen.stroke();
      pen.globalAlpha = 1;
    }
    data.pulleys.forEach((pulley, n) => this.pulley(pen, pulley, ...centers[n], now(mode.angle[n]), ink, page));
    pen.lineJoin = "round"; pen.strokeStyle = ink; pen.lineWidth = 1; pen.setLineDash([2, 4]);
    this.line(pen, data.place);
    pen.setLineDash([]); pen.strokeStyle = mode.color; pen.lineWidth = 4;
    this.line(pen, data.place.map(([x, y], n) => {
      const [a, b, c, d] = mode.belt.subarray(4 * n, 4 * n + 4);
      return [x + now([a, b]), y + now([c, d])];
    }));
    this.scrub.value = 1000 * this.phase;
    this.clock.textContent = `${Math.round(360 * this.phase)}° of a period`;
  }
  line(pen, points) {
    pen.beginPath();
    for (const point of points) pen.lineTo(...this.to(...point));
    pen.closePath(); pen.stroke();
  }
}
