// The page: what it shows, and when it asks for more.
//
// While the user turns the model, every frame shows the last draft from the current camera, and at most
// one request for the next draft is pending. At rest, the exact drawing follows.

/** Milliseconds of rest after which the exact drawing is requested. */
const REST = 150;
/** Drafts that take longer are not requested while turning. */
const SLOW = 400;
/** A drawing that takes longer shows its progress. */
const PATIENCE = 1000;

const by = (id) => document.getElementById(id);

class App {
  constructor() {
    this.server = new Server(location.hash.slice(1));
    this.paper = new Paper(by("paper"));
    this.controls = new Controls(by("groups"), (name, value) => this.optionChanged(name, value));
    this.formulas = new Formulas(by("formulas"), () => this.changed(REST));
    /** Grows with each change of camera or options. */
    this.version = 0;
    /** The versions of the exact drawing on display and of the last draft. */
    this.exactOf = this.draftOf = -1;
    /** Drafts of other options show other lines. */
    this.optionsVersion = 0;
    this.isTurning = false;
    this.isExactDue = false;
    this.draftMs = 0;
    /** Drafts that arrived while turning, and when: a counter for the page alone. */
    this.counter = { drafts: 0, milliseconds: 0 };
    this.listen();
    this.connect();
  }

  async connect() {
    try {
      await this.server.events((event) => this.happened(event));
      this.say("hiddenline has stopped.");
    } catch (error) {
      this.say(error.message);
    }
    this.badge("off", "not connected");
  }

  happened(event) {
    if (event.event === "hello") this.meet(event.about);
    else if (event.event === "shown") this.renew();
    else if (event.event === "changed") { this.forget(); this.changed(0); }
    else if (event.event === "progress") this.progress(event);
  }

  /** Starts with what the server shows. */
  meet(about) {
    this.about = about;
    const options = { ...about.options };
    this.camera = new Camera(options);
    for (const name of OF_CAMERA) delete options[name];
    by("title").textContent = about.command === "draw" ? about.subjects.map((path) => path.split("/").pop()).join(", ")
      : about.formulas ? "Surface" : about.stem;
    document.title = `${by("title").textContent} – hiddenline`;
    this.formulas.build(about, about.options);
    delete options.set;
    this.options = options;
    this.controls.build(about, { ...options, ...about.options });
    by("format").replaceChildren(...about.formats.map((name) => make("option", { value: name, textContent: name.toUpperCase() })));
    this.forget();
    this.changed(0);
  }

  /** Shows another model: everything starts over. */
  async renew() {
    by("welcome").hidden = true;
    location.reload();
  }

  forget() {
    this.draft = null;
    this.draftMs = 0;
    this.optionsVersion++;
  }

  optionChanged(name, value) {
    if (OF_CAMERA.includes(name)) {
      const all = { ...this.camera.options(), ...this.typedCamera() };
      if (value === undefined || value === "") delete all[name]; else all[name] = value;
      if (name === "view") { delete all.azimuth; delete all.elevation; delete all.up; }
      if (name === "azimuth" || name === "elevation") delete all.view;
      const known = this.camera.known;
      this.camera = new Camera(all);
      this.camera.known = known;
      this.camera.isAsTyped = false;
      if (name === "view-height" && value) this.dropPlacements();
    } else if (value === undefined || value === "" || (Array.isArray(value) && !value.length)) {
      delete this.options[name];
    } else {
      this.options[name] = value;
    }
    this.forget();
    this.changed(REST);
  }

  /** The camera options as typed, until they change. */
  typedCamera() {
    if (!this.camera.isAsTyped) return {};
    return Object.fromEntries(OF_CAMERA.filter((name) => name in this.about.options).map((name) => [name, this.about.options[name]]));
  }

  /** Other options that set the size of the drawing. */
  dropPlacements() {
    for (const name of ["drawing-scale", "fit-fov"]) {
      delete this.options[name];
      delete this.controls.values[name];
    }
    this.controls.refresh();
  }

  asked(more) {
    return { camera: this.camera.options(), options: { ...this.options, ...this.formulas.options() }, ...more };
  }

  /** Something has changed; the exact drawing follows after this many milliseconds, or on request. */
  changed(rest) {
    this.version++;
    this.isExactDue = false;
    clearTimeout(this.timer);
    this.exactRequest?.abort();
    if (rest !== null) this.settle(rest);
    this.frame();
    this.pump();
  }

  /** Requests the exact drawing after this many milliseconds. */
  settle(rest) {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      this.isTurning = false;
      this.isExactDue = true;
      this.pump();
    }, rest);
  }

  /** The camera has moved. */
  moved(rest) {
    this.isTurning = true;
    this.paper.drawnMm = Infinity;
    by("order").value = by("order").max;
    this.controls.values = { ...this.options, ...(this.camera.options() ?? {}) };
    this.changed(rest);
  }

  /** Draws in the next frame. */
  frame() {
    if (this.isFramed) return;
    this.isFramed = true;
    requestAnimationFrame(() => {
      this.isFramed = false;
      this.show();
    });
  }

  show() {
    const isExact = this.exactOf === this.version;
    if (isExact || !this.draft || !this.camera) this.paper.drawExact();
    else this.paper.drawDraft(this.draft, this.camera, this.draft.facts.page);
    // Errors are shown elsewhere; the page keeps the last valid drawing.
    if (isExact && this.hasFailed) this.badge("old", "not drawn");
    else this.badge(isExact ? "exact" : "draft", isExact ? "exact" : "draft");
    by("paper").setAttribute("aria-busy", String(!isExact));
    if (this.camera) by("view").textContent = this.camera.describe();
  }

  /** Asks for what is missing, one request after the other. */
  async pump() {
    if (this.isAsking || !this.about) return;
    this.isAsking = true;
    try {
      for (;;) {
        const version = this.version;
        const lacksDraft = this.draftOf !== version || !this.draft;
        if (this.isExactDue && this.exactOf !== version) await this.askExact(version);
        else if (this.isTurning && lacksDraft && this.draftMs < SLOW) await this.askDraft(version);
        else if (!this.isTurning && lacksDraft && this.exactOf === version && this.draftMs < SLOW) await this.askDraft(version);
        else return;
      }
    } finally {
      this.isAsking = false;
    }
  }

  async askDraft(version) {
    const options = this.optionsVersion;
    try {
      const draft = await this.server.draw(this.asked({ want: "drag" }));
      this.draftMs = draft.ms;
      this.counter.drafts++;
      this.counter.milliseconds += draft.ms;
      if (options === this.optionsVersion) {
        this.draft = draft;
        this.draftOf = version;
        if (this.exactOf !== this.version) {
          this.camera.learn(draft.facts.camera, false);
          this.frame();
        }
      }
    } catch (error) {
      if (error.status !== 409) { this.draftMs = Infinity; this.failed(error); }
    }
  }

  async askExact(version, more = {}) {
    this.exactRequest = new AbortController();
    this.late = setTimeout(() => {
      this.isLate = true;
      this.progress({ stage: "drawing", share: null });
    }, PATIENCE);
    try {
      const drawing = await this.server.draw(this.asked({ want: "exact", ...more }), this.exactRequest.signal);
      this.failed(null);
      if (version === this.version) {
        this.exactOf = version;
        this.paper.setExact(drawing);
        this.seek();
        this.camera.learn(drawing.facts.camera, this.about.camera_file);
        this.tell(drawing.facts);
        this.frame();
      }
      return drawing;
    } catch (error) {
      if (error.status === 409) await new Promise((resolve) => setTimeout(resolve, 30));
      else if (error.name !== "AbortError") { this.exactOf = version; this.failed(error); this.frame(); }
    } finally {
      clearTimeout(this.late);
      this.isLate = false;
      by("progress").hidden = true;
      this.exactRequest = null;
    }
    return null;
  }

  /** Describes the drawing in words. */
  tell(facts) {
    const { strokes, meters, minutes, lifts, seconds } = facts;
    const hours = minutes >= 60 ? `${Math.floor(minutes / 60)} h ${Math.round(minutes % 60)} min`
      : `${minutes < 10 ? minutes.toFixed(1) : Math.round(minutes)} min`;
    by("stats").textContent =
      `${strokes} stroke${strokes === 1 ? "" : "s"} · ${meters.toFixed(1)} m · ${hours} · ${lifts} lift${lifts === 1 ? "" : "s"}`;
    by("stats").title = `${facts.summary}\nDrawn in ${seconds.toFixed(2)} s`;
    this.command = facts.command;
    this.showCommand();
    const notes = [...facts.warnings, ...facts.hints];
    by("notes").replaceChildren(...notes.map((text) => make("li", { textContent: text })));
    by("notes").hidden = !notes.length;
    by("paper").setAttribute("aria-label", `Drawing of ${by("title").textContent}: ${this.camera.describe()}`);
    const shown = this.camera.options() ?? this.typedCamera();
    this.controls.values = { ...this.options, ...shown };
    this.controls.refresh();
    for (const button of document.querySelectorAll("[data-view]")) {
      button.setAttribute("aria-pressed", String(this.camera.view === button.dataset.view));
    }
    by("projection").textContent = this.camera.isPerspective ? "Perspective" : "Orthographic";
    by("fit").disabled = !this.camera.height;
  }

  failed(error) {
    this.hasFailed = Boolean(error);
    const about = error?.about;
    const isKnown = this.formulas.fail(about) || this.controls.fail(about?.option, error?.message);
    if (!isKnown) this.controls.fail(null);
    this.say(error && !isKnown ? error.message : "");
    if (!error) return;
    if (about?.parameter && !this.formulas.parameters.has(about.parameter)) {
      // A free letter gets a slider.
      this.formulas.add(about.parameter);
      const active = document.activeElement?.id;
      const place = document.activeElement?.selectionStart;
      this.formulas.show();
      const field = active && by(active);
      field?.focus();
      if (field && place !== undefined) field.setSelectionRange?.(place, place);
      this.changed(0);
    }
  }

  say(text) {
    by("message").textContent = text;
    by("message").hidden = !text;
  }

  badge(state, text) {
    const badge = by("badge");
    if (badge.dataset.state === state) return;
    badge.dataset.state = state;
    badge.textContent = text;
  }

  progress({ stage, share }) {
    if (!this.isLate) return;
    by("progress").hidden = false;
    by("stage").textContent = stage;
    const bar = by("share");
    if (share === null) bar.removeAttribute("value");
    else bar.value = share;
  }

  async save() {
    const format = by("format").value;
    by("save").disabled = true;
    try {
      const { name, blob } = await this.server.file(this.asked({ format }));
      const address = URL.createObjectURL(blob);
      const link = make("a", { href: address, download: name });
      link.click();
      setTimeout(() => URL.revokeObjectURL(address), 10000);
      by("saved").textContent = `Saved ${name}`;
    } catch (error) {
      this.failed(error);
    } finally {
      by("save").disabled = false;
      by("save").focus();
    }
  }

  /** The command for the format that is chosen: formats are named like their extensions. */
  showCommand() {
    by("command").textContent = this.command?.replace(/\.svg('?)$/, `.${by("format").value}$1`) ?? "";
  }

  async copy() {
    try {
      await navigator.clipboard.writeText(by("command").textContent);
      by("saved").textContent = "Copied";
    } catch {
      getSelection().selectAllChildren(by("command"));
    }
  }

  /** Plays the stroke order. */
  play() {
    const order = by("order");
    if (this.playing) { cancelAnimationFrame(this.playing); this.playing = null; this.playButton(); return; }
    if (Number(order.value) >= Number(order.max)) order.value = 0;
    let last = performance.now();
    const step = (now) => {
      order.value = Number(order.value) + (now - last) / 10000;
      last = now;
      this.seek();
      this.playing = Number(order.value) < Number(order.max) ? requestAnimationFrame(step) : null;
      this.playButton();
    };
    this.playing = requestAnimationFrame(step);
    this.playButton();
  }

  playButton() {
    by("play").textContent = this.playing ? "Pause" : "Play";
  }

  seek() {
    const share = Number(by("order").value);
    this.paper.drawnMm = share >= 1 ? Infinity : share * this.paper.totalMm;
    by("order").setAttribute("aria-valuetext", `${Math.round(share * 100)} % drawn`);
    this.frame();
  }

  listen() {
    const app = this;
    const scale = () => this.paper.scale;
    const act = {
      begin: () => ({ azimuth: this.camera?.azimuth ?? 0, elevation: this.camera?.elevation ?? 0 }),
      turnTo({ azimuth, elevation }, dx, dy) { app.camera.turnTo(azimuth + dx, elevation + dy); app.moved(null); },
      turn(dx, dy) { app.camera.turn(dx, dy); app.moved(null); },
      pan(x, y) { app.dropPlacements(); app.camera.pan(x / scale(), y / scale(), app.paper.page); app.moved(null); },
      zoom(factor, x, y) {
        app.dropPlacements();
        app.camera.zoom(factor, app.paper.millimeters(x, y), app.paper.page);
        app.moved(null);
      },
      show(name) { app.camera.show(name); app.moved(0); },
      toggleProjection() { app.camera.project(app.camera.isPerspective ? "orthographic" : "perspective"); app.moved(0); },
      fit() { app.camera.fit(); app.moved(0); },
      reset() {
        const known = app.camera.known;
        app.camera = new Camera(app.about.options);
        app.camera.known = known;
        app.moved(0);
      },
      rest() { if (app.isTurning) app.settle(0); },
      settle() { if (app.isTurning) app.settle(REST); },
      async pick(x, y) {
        const drawing = await app.server.draw(app.asked({ want: "exact", pick: app.paper.millimeters(x, y) })).catch(() => null);
        const point = drawing?.facts.picked;
        if (!point) return;
        app.dropPlacements();
        app.camera.lookAt(point, app.paper.page);
        app.moved(0);
      },
    };
    const guarded = Object.fromEntries(Object.entries(act).map(([name, action]) =>
      [name, (...given) => (this.camera || name === "begin" ? action.apply(act, given) : undefined)]));
    listenToGestures(by("paper"), guarded);
    for (const button of document.querySelectorAll("[data-view]")) {
      button.addEventListener("click", () => guarded.show(button.dataset.view));
    }
    by("projection").addEventListener("click", () => guarded.toggleProjection());
    by("fit").addEventListener("click", () => guarded.fit());
    by("save").addEventListener("click", () => this.save());
    by("copy").addEventListener("click", () => this.copy());
    by("play").addEventListener("click", () => this.play());
    by("order").addEventListener("input", () => this.seek());
    by("stop").addEventListener("click", () => {
      this.isExactDue = false;
      this.exactRequest?.abort();
    });
    by("format").addEventListener("change", () => this.showCommand());
    new ResizeObserver(() => this.frame()).observe(by("paper"));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.frame());
    this.listenToDrops();
  }

  listenToDrops() {
    const hint = by("welcome");
    addEventListener("dragover", (event) => { event.preventDefault(); hint.hidden = false; });
    addEventListener("dragleave", (event) => { if (!event.relatedTarget) hint.hidden = true; });
    addEventListener("drop", async (event) => {
      event.preventDefault();
      hint.hidden = true;
      const [file] = event.dataTransfer.files;
      if (!file) return;
      this.say(`Reading ${file.name} …`);
      try {
        await this.server.model(file);
      } catch (error) {
        this.failed(error);
      }
    });
  }
}

const app = new App();
