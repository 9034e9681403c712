// The camera of the page, in the words of the command line: a turntable with z up.

const DEGREES = Math.PI / 180;
/** Azimuth and elevation of the named views. */
const NAMED = {
  front: [0, 0], right: [90, 0], back: [180, 0], left: [270, 0], top: [0, 90], bottom: [0, -90],
  isometric: [45, 35.264], dimetric: [20.705, 19.471], trimetric: [30, 25],
};
/** Options that the camera sets. */
const OF_CAMERA = ["azimuth", "elevation", "view", "projection", "fov", "near", "target", "distance",
  "view-height", "up", "eye"];

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) =>
  [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const plus = (a, b, factor = 1) => [a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]];
const length = (a) => Math.hypot(...a);
const unit = (a) => { const size = length(a); return a.map((x) => x / size); };
const tenth = (x) => Math.round(x * 10) / 10 || 0;
/** At most six significant digits. */
const brief = (x) => String(Number(x.toPrecision(6)));

class Camera {
  /** @param options the options that were typed. */
  constructor(options) {
    const number = (name) => (name in options ? Number(options[name]) : null);
    const vector = (name) => (name in options ? options[name].split(",").map(Number) : null);
    this.view = options.view ?? null;
    const [azimuth, elevation] = NAMED[this.view] ?? [30, 25];
    this.azimuth = number("azimuth") ?? azimuth;
    this.elevation = number("elevation") ?? elevation;
    this.projection = options.projection ?? (this.view ? "orthographic" : "perspective");
    this.fov = number("fov") ?? 30;
    this.near = options.near ?? null;
    this.target = vector("target");
    this.distance = number("distance");
    this.height = number("view-height");
    this.up = vector("up");
    /** Until something is changed, the camera is what was typed, perhaps a file. */
    this.isAsTyped = true;
    /** The eye was typed, or read from a file: it becomes angles when it moves. */
    this.hasEye = "eye" in options;
    /** Target and distance that the scene gives, from the last answer. */
    this.known = { target: [0, 0, 0], distance: 1 };
  }

  /** Adopts the camera of the last answer. */
  learn({ eye, target, up, projection, fov }, fromFile) {
    const offset = plus(eye, target, -1);
    this.known = { target, distance: length(offset) };
    if (this.isAsTyped && (this.hasEye || fromFile)) {
      const [x, y, z] = unit(offset);
      this.azimuth = tenth(Math.atan2(x, -y) / DEGREES);
      this.elevation = tenth(Math.asin(Math.max(-1, Math.min(1, z))) / DEGREES);
      this.target = target;
      this.distance = this.known.distance;
      this.projection = projection;
      this.fov = fov ?? this.fov;
      const isUsual = up[0] === 0 && up[1] === 0 && up[2] > 0;
      this.up = isUsual || Math.abs(this.elevation) === 90 ? null : up;
    }
  }

  /** The options for it; undefined while it is as typed. */
  options() {
    if (this.isAsTyped) return undefined;
    const options = {};
    if (this.view) {
      options.view = this.view;
    } else {
      options.azimuth = brief(this.azimuth);
      options.elevation = brief(this.elevation);
      const up = this.upward();
      if (up) options.up = up.map((x) => brief(x)).join(",");
    }
    const usual = this.view ? "orthographic" : "perspective";
    if (this.projection !== usual) options.projection = this.projection;
    if (this.fov !== 30) options.fov = brief(this.fov);
    if (this.near) options.near = this.near;
    if (this.target) options.target = this.target.map((x) => this.rounded(x)).join(",");
    if (this.distance) options.distance = brief(this.distance);
    if (this.height) options["view-height"] = brief(this.height);
    return options;
  }

  /** A coordinate, to a small part of what is seen. */
  rounded(x) {
    const step = 10 ** Math.floor(Math.log10((this.height ?? this.distance ?? this.known.distance) / 1e4));
    return String(Number((Math.round(x / step) * step).toPrecision(12)));
  }

  /** The up direction, where it differs from the default of the command line. */
  upward() {
    if (this.up) return this.up;
    if (Math.abs(this.elevation) < 90) return null;
    // Seen from straight above or below, the picture turns with the azimuth.
    const [sin, cos] = [Math.sin(this.azimuth * DEGREES), Math.cos(this.azimuth * DEGREES)];
    const up = this.elevation > 0 ? [-sin, cos, 0] : [sin, -cos, 0];
    const isUsual = Math.abs(up[0]) < 1e-9 && up[1] > 0;
    return isUsual ? null : up.map((x) => Number(x.toFixed(6)));
  }

  /** Directions to the right, upwards and away, the target, and the distance of the eye from it. */
  frame() {
    const angles = [this.azimuth, this.elevation].map((angle) => angle * DEGREES);
    const [sinA, cosA, sinE, cosE] =
      [Math.sin(angles[0]), Math.cos(angles[0]), Math.sin(angles[1]), Math.cos(angles[1])];
    const forward = [-sinA * cosE, cosA * cosE, -sinE];
    const isVertical = Math.abs(this.elevation) === 90;
    const bottom = this.view === "bottom" ? [0, -1, 0] : null;
    const up = bottom ?? this.upward() ?? (isVertical ? [0, 1, 0] : [0, 0, 1]);
    const right = unit(cross(forward, up));
    const distance = this.distance ?? this.known.distance;
    return { right, upward: cross(right, forward), forward, target: this.target ?? this.known.target, distance };
  }

  get isPerspective() { return this.projection === "perspective"; }

  /** Turns by degrees. A named view becomes angles. */
  turn(azimuth, elevation) {
    this.turnTo(this.azimuth + azimuth, this.elevation + elevation);
  }

  turnTo(azimuth, elevation) {
    this.isAsTyped = false;
    this.view = null;
    this.azimuth = tenth(((azimuth % 360) + 360) % 360);
    this.elevation = tenth(Math.max(-90, Math.min(90, elevation)));
  }

  /** Looks as a named view does, at the same place. */
  show(name) {
    this.isAsTyped = false;
    this.view = name;
    [this.azimuth, this.elevation] = NAMED[name];
    this.up = null;
    this.projection = "orthographic";
  }

  project(kind) {
    this.isAsTyped = false;
    this.projection = kind;
  }

  /**
   * From a drawing that is fitted to the page to one with a height of its own, which looks the same.
   * @param page the page of the last answer, with the scale and the place of the image on it.
   */
  setFrame(page) {
    this.isAsTyped = false;
    if (this.height) return;
    const { right, upward, target, distance } = this.frame();
    const size = (this.isPerspective ? distance : 1) / page.scale;
    const [x, y] = [page.width / 2 - page.origin[0], page.origin[1] - page.height / 2];
    this.target = plus(plus(target, right, x * size), upward, y * size);
    this.distance = distance;
    this.height = (page.height - 2 * page.margin) * size;
  }

  /** Model units on one millimeter of paper, at the target. */
  unitsPerMm(page) { return this.height / (page.height - 2 * page.margin); }

  /** Moves what is seen by millimeters on paper, to the right and down. */
  pan(x, y, page) {
    this.setFrame(page);
    const { right, upward } = this.frame();
    const size = this.unitsPerMm(page);
    this.target = plus(plus(this.target, right, -x * size), upward, y * size);
  }

  /** Zooms by a factor, toward a place on paper in millimeters. */
  zoom(factor, [x, y], page) {
    this.setFrame(page);
    const { right, upward } = this.frame();
    const moved = this.unitsPerMm(page) * (1 - 1 / factor);
    const [dx, dy] = [x - page.width / 2, page.height / 2 - y];
    this.target = plus(plus(this.target, right, dx * moved), upward, dy * moved);
    this.height /= factor;
    if (this.isPerspective) this.distance /= factor;
  }

  /** Looks at a point, from as far away as before. */
  lookAt(point, page) {
    this.setFrame(page);
    this.target = point;
  }

  /** Fits the whole drawing to the page again. */
  fit() {
    this.isAsTyped = false;
    [this.target, this.distance, this.height] = [null, null, null];
  }

  /** The view in words. */
  describe() {
    const where = this.view ? `${this.view} view`
      : `azimuth ${brief(this.azimuth)}°, elevation ${brief(this.elevation)}°`;
    return `${where}, ${this.projection}`;
  }
}
