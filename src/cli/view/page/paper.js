// The sheet of paper on the canvas, with the pens at their true width.

/** Millimeters of a scale bar, the longest that fits is taken. */
const BARS = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000];
/** Pixels around the paper. */
const AROUND = 28;
const BELOW = 44;

class Paper {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
    this.page = { width: 297, height: 210, margin: 10 };
    this.pens = [];
    /** Millimeters that are drawn, in stroke order; infinite for all. */
    this.drawnMm = Infinity;
  }

  /** The size of the canvas in pixels of the screen, and where the paper is on it. */
  layout() {
    const ratio = window.devicePixelRatio || 1;
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (this.canvas.width !== w || this.canvas.height !== h) {
      [this.canvas.width, this.canvas.height] = [w, h];
    }
    const around = Math.min(AROUND, width / 16);
    const scale = Math.max(0.01, Math.min((width - 2 * around) / this.page.width,
      (height - around - BELOW) / this.page.height));
    this.scale = scale;
    this.left = (width - scale * this.page.width) / 2;
    this.top = Math.max(around, (height - BELOW + around - scale * this.page.height) / 2);
    return ratio;
  }

  /** Millimeters on the paper for a place on the canvas. */
  millimeters(x, y) { return [(x - this.left) / this.scale, (y - this.top) / this.scale]; }

  /** Shows an exact drawing. */
  setExact(drawing) {
    this.page = drawing.facts.page;
    this.pens = drawing.facts.pens;
    const { points, starts, groups } = drawing;
    const lengths = new Float64Array(starts.length);
    for (let stroke = 0; stroke + 1 < starts.length; stroke++) {
      let sum = 0;
      for (let k = starts[stroke] + 1; k < starts[stroke + 1]; k++) {
        sum += Math.hypot(points[2 * k] - points[2 * k - 2], points[2 * k + 1] - points[2 * k - 1]);
      }
      lengths[stroke + 1] = lengths[stroke] + sum;
    }
    this.exact = { points, starts, groups, lengths };
    this.paths = null;
  }

  get totalMm() { return this.exact?.lengths.at(-1) ?? 0; }

  /** Draws the paper with the exact drawing, as far as the pens have come. */
  drawExact() {
    this.begin();
    if (!this.exact) return;
    const { points, starts, groups, lengths } = this.exact;
    const isAll = this.drawnMm >= this.totalMm;
    if (isAll) {
      this.paths ??= groups.map(({ first, end }) => {
        const path = new Path2D();
        for (let stroke = first; stroke < end; stroke++) trace(path, points, starts[stroke], starts[stroke + 1]);
        return path;
      });
      groups.forEach(({ pen }, k) => this.ink(this.pens[pen], this.paths[k]));
      return;
    }
    let tip = null;
    for (const { pen, first, end } of groups) {
      const path = new Path2D();
      for (let stroke = first; stroke < end && lengths[stroke] < this.drawnMm; stroke++) {
        tip = partly(path, points, starts[stroke], starts[stroke + 1], this.drawnMm - lengths[stroke]);
      }
      this.ink(this.pens[pen], path);
    }
    if (tip) this.mark(tip);
  }

  /** Draws the paper with a draft as a camera sees it. */
  drawDraft(draft, camera, placement) {
    this.begin();
    const { xs, ys, isSeen } = seen(draft, camera);
    const map = placedBy(placement, this.page, camera, xs, ys, isSeen);
    this.context.save();
    const margin = this.page.margin;
    this.context.beginPath();
    this.context.rect(margin, margin, this.page.width - 2 * margin, this.page.height - 2 * margin);
    this.context.clip();
    for (const { pen, first, end } of draft.groups) {
      const path = new Path2D();
      for (let stroke = first; stroke < end; stroke++) {
        let isDown = false;
        for (let k = draft.starts[stroke]; k < draft.starts[stroke + 1]; k++) {
          if (!isSeen[k]) { isDown = false; continue; }
          const [x, y] = [map.x + map.scale * xs[k], map.y - map.scale * ys[k]];
          if (isDown) path.lineTo(x, y); else path.moveTo(x, y);
          isDown = true;
        }
      }
      this.ink(draft.facts.pens[pen], path);
    }
    this.context.restore();
    // Where a drag goes on from.
    this.page = { ...this.page, scale: map.scale, origin: [map.x, map.y] };
  }

  begin() {
    const ratio = this.layout();
    const { context, scale } = this;
    const style = getComputedStyle(this.canvas);
    const color = (name) => style.getPropertyValue(name).trim();
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    const { width, height, margin } = this.page;
    context.save();
    context.shadowColor = color("--shadow");
    context.shadowBlur = 18 * ratio;
    context.shadowOffsetY = 3 * ratio;
    context.fillStyle = "#fff";
    context.fillRect(this.left, this.top, scale * width, scale * height);
    context.restore();
    this.bar(color("--muted"));
    context.setTransform(ratio * scale, 0, 0, ratio * scale, ratio * this.left, ratio * this.top);
    context.lineWidth = 1 / scale / ratio;
    context.strokeStyle = "#d4d4d4";
    context.setLineDash([4 / scale, 4 / scale]);
    if (margin > 0) context.strokeRect(margin, margin, width - 2 * margin, height - 2 * margin);
    context.setLineDash([]);
    context.lineJoin = context.lineCap = "round";
  }

  /** A scale bar below the paper. */
  bar(color) {
    const { context, scale } = this;
    const mm = BARS.findLast((mm) => mm * scale <= 110) ?? BARS[0];
    const [x, y] = [this.left, this.top + scale * this.page.height + 18];
    context.strokeStyle = context.fillStyle = color;
    context.lineWidth = 1;
    context.beginPath();
    context.moveTo(x + 0.5, y - 4); context.lineTo(x + 0.5, y);
    context.lineTo(x + mm * scale, y); context.lineTo(x + mm * scale, y - 4);
    context.stroke();
    context.font = "12px system-ui, sans-serif";
    context.textBaseline = "middle";
    const length = `${mm} mm`;
    const lengthAt = x + mm * scale + 7;
    context.fillText(length, lengthAt, y - 2);
    const text = this.page.description ?? "";
    const right = this.left + scale * this.page.width;
    // On a small sheet there is room for one of the two.
    if (right - context.measureText(text).width > lengthAt + context.measureText(length).width + 7) {
      context.textAlign = "right";
      context.fillText(text, right, y - 2);
      context.textAlign = "left";
    }
  }

  ink(pen, path) {
    if (!pen) return;
    this.context.strokeStyle = pen.color;
    // No thinner than the screen can show.
    this.context.lineWidth = Math.max(pen.width, 0.6 / this.scale);
    this.context.stroke(path);
  }

  mark([x, y]) {
    this.context.beginPath();
    this.context.arc(x, y, 4 / this.scale, 0, 2 * Math.PI);
    this.context.fillStyle = "#d33";
    this.context.fill();
  }
}

function trace(path, points, from, to) {
  path.moveTo(points[2 * from], points[2 * from + 1]);
  for (let k = from + 1; k < to; k++) path.lineTo(points[2 * k], points[2 * k + 1]);
}

/** The first millimeters of a stroke; returns where they end. */
function partly(path, points, from, to, millimeters) {
  let [x, y] = [points[2 * from], points[2 * from + 1]];
  path.moveTo(x, y);
  for (let k = from + 1; k < to && millimeters > 0; k++) {
    const [dx, dy] = [points[2 * k] - x, points[2 * k + 1] - y];
    const size = Math.hypot(dx, dy);
    const share = size > millimeters ? millimeters / size : 1;
    [x, y] = [x + share * dx, y + share * dy];
    path.lineTo(x, y);
    millimeters -= size;
  }
  return [x, y];
}

/** The image of a draft's points as a camera sees them, y upwards. */
function seen(draft, camera) {
  const { right, upward, forward, target, distance } = camera.frame();
  const [ox, oy, oz] = plus(draft.facts.camera.target, target, -1);
  const n = draft.points.length / 3;
  const [xs, ys, isSeen] = [new Float64Array(n), new Float64Array(n), new Uint8Array(n)];
  const near = camera.isPerspective ? distance * 1e-3 : -Infinity;
  for (let k = 0; k < n; k++) {
    const [x, y, z] = [draft.points[3 * k] + ox, draft.points[3 * k + 1] + oy, draft.points[3 * k + 2] + oz];
    const depth = distance + x * forward[0] + y * forward[1] + z * forward[2];
    if (depth <= near) continue;
    const w = camera.isPerspective ? depth : 1;
    isSeen[k] = 1;
    xs[k] = (x * right[0] + y * right[1] + z * right[2]) / w;
    ys[k] = (x * upward[0] + y * upward[1] + z * upward[2]) / w;
  }
  return { xs, ys, isSeen };
}

/** Scale and place of the image on the page, as the command line would place it. */
function placedBy({ placement, value }, page, camera, xs, ys, isSeen) {
  const { distance } = camera.frame();
  const usable = [page.width - 2 * page.margin, page.height - 2 * page.margin];
  const units = camera.isPerspective ? distance : 1;
  let [lowX, lowY, highX, highY] = [Infinity, Infinity, -Infinity, -Infinity];
  for (let k = 0; k < xs.length; k++) {
    if (!isSeen[k]) continue;
    if (xs[k] < lowX) lowX = xs[k];
    if (xs[k] > highX) highX = xs[k];
    if (ys[k] < lowY) lowY = ys[k];
    if (ys[k] > highY) highY = ys[k];
  }
  let center = lowX <= highX ? [(lowX + highX) / 2, (lowY + highY) / 2] : [0, 0];
  let scale = Math.min(usable[0] / (highX - lowX), usable[1] / (highY - lowY));
  if (camera.height) {
    [scale, center] = [(usable[1] / camera.height) * units, [0, 0]];
  } else if (placement === "scale") {
    scale = value * units;
  } else if (placement === "fov" && camera.isPerspective) {
    [scale, center] = [usable[1] / (2 * Math.tan((camera.fov * DEGREES) / 2)), [0, 0]];
  }
  if (!(scale > 0 && Number.isFinite(scale))) scale = 1;
  return { scale, x: page.width / 2 - scale * center[0], y: page.height / 2 + scale * center[1] };
}
