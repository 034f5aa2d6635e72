// What the scripts of a page share, and the drive moving.

const read = (name) => JSON.parse(document.getElementById(name).textContent);
const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const dark = matchMedia("(prefers-color-scheme: dark)");
const clamp = (value, low, high) => Math.min(Math.max(value, low), high);
const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
const RATES = [1, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001];
const MARKS = 12;

class Picture { // of the drive, on a canvas with a button to play
  constructor(box, data) {
    Object.assign(this, { box, data, playing: false });
    this.find("canvas", "canvas"); this.find("button", ".play"); this.find("scrub", ".scrub"); this.find("clock", ".clock");
    box.hidden = false;
    this.button.onclick = () => this.play(!this.playing);
    this.canvas.onkeydown = (event) => {
      const steps = { ArrowLeft: this.share - 0.005, ArrowRight: this.share + 0.005, Home: 0, End: 1 };
      if (event.key === " ") this.play(!this.playing);
      else if (event.key in steps) { this.play(false); this.at(clamp(steps[event.key], 0, 1)); }
      else return;
      event.preventDefault();
    };
    this.scrub.oninput = () => { this.play(false); this.at(this.scrub.value / 1000); };
  }
  begin() { // once all is known that is drawn
    new ResizeObserver(() => this.resize()).observe(this.box);
    dark.addEventListener("change", () => this.draw());
    this.resize();
  }
  find(name, selector) { this[name] = this.box.querySelector(selector); }
  play(on) {
    if (on === this.playing) return;
    this.playing = on;
    this.button.textContent = on ? "Pause" : "Play";
    if (!on) return;
    let before = performance.now();
    const step = (now) => {
      if (!this.playing) return;
      this.pass(Math.min(now - before, 100) / 1000);
      before = now;
      this.draw();
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }
  resize() {
    const [low, high] = this.data.extent, width = this.box.clientWidth;
    if (!width) return;
    const shape = (high[1] - low[1]) / (high[0] - low[0]);
    const height = clamp(width * shape + 40, 140, 0.7 * innerHeight + 100), ratio = devicePixelRatio || 1;
    this.canvas.style.height = `${height}px`;
    this.canvas.width = width * ratio; this.canvas.height = height * ratio;
    const room = 24;
    this.scale = Math.min((width - 2 * room) / (high[0] - low[0]), (height - 2 * room) / (high[1] - low[1]));
    this.middle = [width / 2 - this.scale * (low[0] + high[0]) / 2, height / 2 + this.scale * (low[1] + high[1]) / 2];
    this.ratio = ratio;
    this.draw();
  }
  to(x, y) { return [this.middle[0] + this.scale * x, this.middle[1] - this.scale * y]; }
  cleared() {
    const pen = this.canvas.getContext("2d");
    pen.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
    return pen;
  }
  pulley(pen, { name, radius }, x, y, angle, ink, page) {
    const r = this.scale * radius;
    pen.fillStyle = page; pen.strokeStyle = ink; pen.lineWidth = 1.2;
    pen.beginPath(); pen.arc(x, y, r, 0, 2 * Math.PI); pen.fill(); pen.stroke();
    pen.globalAlpha = 0.5; pen.lineWidth = Math.max(1, r / 18);
    pen.beginPath();
    for (let spoke = 0; spoke < 3; spoke++) {
      const turned = -angle + (2 * Math.PI * spoke) / 3;
      pen.moveTo(x + 0.12 * r * Math.cos(turned), y + 0.12 * r * Math.sin(turned));
      pen.lineTo(x + (spoke ? 0.7 : 0.92) * r * Math.cos(turned), y + (spoke ? 0.7 : 0.92) * r * Math.sin(turned));
    }
    pen.stroke();
    pen.globalAlpha = 1;
  }
  named(pen, { name, radius, clear }, x, y, ink, page) { // over the belt, which would hide the names of small pulleys
    const r = this.scale * radius;
    pen.fillStyle = ink; pen.font = "600 12px system-ui, sans-serif"; pen.textAlign = "center"; pen.textBaseline = "middle";
    const wide = pen.measureText(name).width;
    pen.lineWidth = 4; pen.strokeStyle = page;
    const [right, up] = clear || [0, -1], outside = wide > 1.7 * r; // beyond the arc, where no span runs
    const at = (place, room, most) => clamp(place, room + 2, most / this.ratio - room - 2);
    const across = at(x + (outside ? right * (r + 9 + (Math.abs(right) > 0.7 ? wide / 2 : 0)) : 0), wide / 2, this.canvas.width);
    const beside = Math.abs(across - x) > r + wide / 2; // or above or below, where the picture ends
    const to = [across, at(y - (outside ? (beside ? up : Math.sign(up) || 1) * (r + 12) : 0), 6, this.canvas.height)];
    pen.strokeText(name, ...to); pen.fillText(name, ...to);
  }
}

class Motion extends Picture {
  constructor(box, data, colors) {
    super(box, data);
    Object.assign(this, { colors, colour: "tension" });
    this.place = new Uint16Array(bytes(data.place).buffer);
    this.shade = { tension: bytes(data.tension), pressure: bytes(data.pressure) };
    this.still = data.time.length === 1;
    this.first = this.still ? 0 : data.time[0];
    this.last = this.still ? this.turn() : data.time[data.time.length - 1];
    this.time = this.last;
    this.find("rates", ".rate"); this.find("kinds", ".colour");
    this.listen();
    this.begin();
  }
  turn() {
    const fastest = Math.max(...this.data.speed.map(Math.abs));
    return this.data.pace ? this.data.length / Math.abs(this.data.pace) : (2 * Math.PI) / fastest;
  }
  listen() {
    const fastest = Math.max(...this.data.speed.map(Math.abs)) / (2 * Math.PI);
    const wanted = RATES.find((rate) => rate * fastest <= 0.7) ?? RATES[RATES.length - 1];
    for (const rate of RATES) {
      const words = rate === 1 ? "real time" : `1/${Math.round(1 / rate)}`;
      this.rates.add(new Option(words, rate, rate === wanted, rate === wanted));
    }
    this.kinds.onchange = () => { this.colour = this.kinds.value; this.label(); this.draw(); };
    this.label();
  }
  label() {
    const [low, high] = this.data.range[this.colour];
    const unit = this.colour === "tension" ? "N" : "N/m";
    const words = (value) => `${Number(value.toPrecision(3))} ${unit}`;
    this.box.querySelector(".low").textContent = words(low);
    this.box.querySelector(".high").textContent = words(high);
    this.box.querySelector(".bar").style.background = `linear-gradient(90deg, ${this.colors.join(",")})`;
  }
  at(share) { this.time = this.first + share * (this.last - this.first); this.draw(); }
  get share() { return (this.time - this.first) / (this.last - this.first); }
  play(on) {
    if (on && this.time >= this.last) this.time = this.first;
    super.play(on);
  }
  pass(seconds) {
    this.time += Number(this.rates.value) * seconds;
    if (this.time < this.last) return;
    if (this.still) this.time = this.first + (this.time - this.last) % (this.last - this.first);
    else { this.time = this.last; this.play(false); }
  }
  instant() {
    const times = this.data.time;
    if (this.still) return { frame: 0, next: 0, part: 0, passed: this.time };
    let frame = times.findIndex((time) => time > this.time) - 1;
    if (frame < 0) frame = times.length - 2;
    return { frame, next: frame + 1, part: clamp((this.time - times[frame]) / (times[frame + 1] - times[frame]), 0, 1), passed: 0 };
  }
  draw() {
    if (!this.scale) return;
    const pen = this.cleared(), { data } = this, now = this.instant();
    const between = (rows) => (one) => rows[now.frame][one] + now.part * (rows[now.next][one] - rows[now.frame][one]);
    const ink = style("--ink"), page = style("--page");
    const angles = between(data.angle);
    const places = data.pulleys.map((pulley, number) => {
      const [a, b] = [data.center[now.frame][number], data.center[now.next][number]];
      return this.to(a[0] + now.part * (b[0] - a[0]), a[1] + now.part * (b[1] - a[1]));
    });
    data.pulleys.forEach((pulley, number) =>
      this.pulley(pen, pulley, ...places[number], angles(number) + now.passed * data.speed[number], ink, page));
    const points = this.belt(now);
    this.stroke(pen, points, now, ink);
    const travel = data.travel[now.frame] + now.part * (data.travel[now.next] - data.travel[now.frame]) + now.passed * data.pace;
    this.marks(pen, points, travel / data.length, page);
    data.pulleys.forEach((pulley, number) => this.named(pen, pulley, ...places[number], ink, page));
    this.scrub.value = 1000 * this.share;
    this.clock.textContent = `${this.time.toPrecision(4)} s`;
  }
  belt(now) {
    const count = this.data.points, low = this.data.extent[0], high = this.data.extent[1];
    const span = Math.max(high[0] - low[0], high[1] - low[1]) / 65535, points = new Array(count);
    for (let n = 0; n < count; n++) {
      const a = 2 * (now.frame * count + n), b = 2 * (now.next * count + n);
      points[n] = this.to(low[0] + span * (this.place[a] + now.part * (this.place[b] - this.place[a])),
        low[1] + span * (this.place[a + 1] + now.part * (this.place[b + 1] - this.place[a + 1])));
    }
    if (this.data.closed) points.push(points[0]);
    return points;
  }
  stroke(pen, points, now, ink) {
    const shade = this.shade[this.colour], count = this.data.points, top = this.colors.length - 1;
    pen.lineCap = "round"; pen.lineJoin = "round";
    pen.strokeStyle = ink; pen.lineWidth = 8;
    pen.beginPath(); points.forEach(([x, y]) => pen.lineTo(x, y)); pen.stroke();
    pen.lineWidth = 5.5;
    for (let n = 0; n + 1 < points.length; n++) {
      const a = shade[now.frame * count + n % count], b = shade[now.next * count + n % count];
      pen.strokeStyle = this.colors[Math.round(top * (a + now.part * (b - a)) / 255)];
      pen.beginPath(); pen.moveTo(...points[n]); pen.lineTo(...points[n + 1]); pen.stroke();
    }
  }
  marks(pen, points, turned, page) {
    pen.strokeStyle = page; pen.lineWidth = 2.5; pen.lineCap = "butt";
    for (let mark = 0; mark < MARKS; mark++) {
      const share = mark / MARKS + (this.data.closed ? turned : 0), along = (share - Math.floor(share)) * (points.length - 1);
      const n = Math.min(Math.floor(along), points.length - 2), [[x0, y0], [x1, y1]] = [points[n], points[n + 1]];
      const size = Math.hypot(x1 - x0, y1 - y0) || 1, x = x0 + (along - n) * (x1 - x0), y = y0 + (along - n) * (y1 - y0);
      const [across, up] = [-3.2 * (y1 - y0) / size, 3.2 * (x1 - x0) / size];
      pen.beginPath(); pen.moveTo(x - across, y - up); pen.lineTo(x + across, y + up); pen.stroke();
    }
  }
}
