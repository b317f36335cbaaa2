// SPDX-License-Identifier: Apache-2.0
import { BufferGeometry, CircleGeometry, Float32BufferAttribute, Group, LineSegments, Mesh, PerspectiveCamera, Scene, Vector3, WebGLRenderer } from 'three';
import { LIGHT, Lit } from './lit';
import { Orbit } from './orbit';
import type { Ray } from './press';
import type { Surface } from './surface';
import type { Vec3 } from './vec';

export interface Look {
  readonly dark: boolean;
  readonly floorLine: string;
  readonly shadow: number; // opacity
}

const FOV = (32 * Math.PI) / 180;

/** Renderer, camera, light and floor. */
export class Stage {
  readonly scene = new Scene();
  readonly orbit = new Orbit();
  readonly drawnBy: string; // the renderer's own name, e.g. SwiftShader; its frame rate depends on it
  readonly software: boolean; // no graphics hardware: each pixel costs processor time
  private readonly camera = new PerspectiveCamera((FOV * 180) / Math.PI, 1, 0.01, 20);
  private readonly renderer: WebGLRenderer;
  private readonly floor = new Group();
  private ratio = 1;
  private width = 0; // CSS pixels: a picture that asked for them would make the browser lay out the page
  private height = 0;

  /** @throws Error when the browser has no WebGL 2 */
  constructor(private readonly canvas: HTMLCanvasElement) {
    this.software = drawsInSoftware();
    this.floor.visible = !this.software; // it waits for the organ
    this.renderer = new WebGLRenderer({ canvas, alpha: true, antialias: !this.software, powerPreference: 'high-performance' });
    this.drawnBy = nameOfRenderer(this.renderer.getContext());
    this.renderer.debug.checkShaderErrors = false; // to ask waits for the shaders' compiler
    this.renderer.setClearColor(0x000000, 0);
    this.camera.up.set(0, 0, 1);
    this.scene.add(this.floor);
  }

  get aspect(): number {
    return this.canvas.clientWidth / Math.max(1, this.canvas.clientHeight);
  }

  /** @param ratio pixels drawn per CSS pixel */
  resize(ratio: number): void {
    const { clientWidth: w, clientHeight: h } = this.canvas;
    if (w === 0 || h === 0 || (w === this.width && h === this.height && ratio === this.ratio)) return;
    [this.width, this.height] = [w, h];
    this.ratio = ratio;
    this.renderer.setDrawingBufferSize(w, h, ratio);
    this.camera.aspect = w / h;
    this.camera.updateProjectionMatrix();
    this.orbit.changed = true;
  }

  get pixelRatio(): number {
    return this.ratio;
  }

  /** Looks at an organ and puts the floor under it. */
  welcome(surface: Surface): void {
    this.orbit.frame(surface.centre, surface.size, FOV, this.aspect);
    let lowest = Infinity;
    for (let i = 2; i < surface.rest.length; i += 3) lowest = Math.min(lowest, surface.rest[i]);
    this.floor.position.set(surface.centre[0], surface.centre[1], lowest - 0.02 * surface.size);
    this.floor.scale.setScalar(surface.size);
  }

  setLook(look: Look): void {
    for (const part of [...this.floor.children]) {
      this.floor.remove(part);
      if (part instanceof Mesh || part instanceof LineSegments) dispose(part);
    }
    this.floor.add(shadowUnder(look), ringsOf(look));
    const strength = look.dark ? 1.25 : 1.55;
    LIGHT.sky.value.setScalar(strength);
    LIGHT.ground.value.setHex(look.dark ? 0x5b5f6b : 0x9c9288).multiplyScalar(strength);
    this.orbit.changed = true;
  }

  /** The floor is drawn from now on: without graphics hardware it takes long to compile. */
  showFloor(): void {
    this.floor.visible = true;
    this.orbit.changed = true;
  }

  draw(): void {
    const { position: p, target: t } = this.orbit;
    this.camera.position.set(...p);
    this.camera.lookAt(...t);
    this.renderer.render(this.scene, this.camera);
    this.orbit.changed = false;
  }

  /** The ray through a point of the picture, in CSS pixels of the page. */
  rayAt(clientX: number, clientY: number): Ray {
    const box = this.canvas.getBoundingClientRect();
    const x = (2 * (clientX - box.left)) / box.width - 1;
    const y = 1 - (2 * (clientY - box.top)) / box.height;
    this.camera.position.set(...this.orbit.position);
    this.camera.lookAt(...this.orbit.target);
    this.camera.updateMatrixWorld();
    const through = new Vector3(x, y, 0.5).unproject(this.camera).sub(this.camera.position).normalize();
    return { origin: this.orbit.position, direction: [through.x, through.y, through.z] };
  }

  /** A world point's place in the picture, CSS pixels from the canvas's corner; undefined behind the camera. */
  onScreen(point: Vec3): { x: number; y: number } | undefined {
    const at = new Vector3(...point).project(this.camera);
    if (at.z > 1) return undefined;
    return { x: (0.5 + 0.5 * at.x) * this.width, y: (0.5 - 0.5 * at.y) * this.height };
  }

  /** CSS pixels per metre at the camera's target. */
  get pixelsPerMetre(): number {
    return this.height / (2 * this.orbit.distance * Math.tan(FOV / 2));
  }

  get fov(): number {
    return FOV;
  }
}

const NAMES_OF_SOFTWARE = /swiftshader|llvmpipe|softpipe|basic render/i;

/** Of a canvas of its own, since smooth edges are asked for with the context. Chromium makes none where it would draw in software. */
function drawsInSoftware(): boolean {
  const gl = document.createElement('canvas').getContext('webgl2', { failIfMajorPerformanceCaveat: true });
  const software = gl === null || NAMES_OF_SOFTWARE.test(nameOfRenderer(gl));
  gl?.getExtension('WEBGL_lose_context')?.loseContext();
  return software;
}

/** To be asked before anything is drawn: asking waits for all that is. */
function nameOfRenderer(gl: WebGLRenderingContext | WebGL2RenderingContext): string {
  const ext = gl.getExtension('WEBGL_debug_renderer_info');
  return String(gl.getParameter(ext ? ext.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
}

/** Frees its memory on the graphics card. */
function dispose(part: Mesh | LineSegments): void {
  part.geometry.dispose();
  for (const material of [part.material].flat()) material.dispose();
}

/** Dark in the middle, gone at the edge. */
function shadowUnder(look: Look): Mesh {
  const geometry = new CircleGeometry(0.55, 48);
  const colours = new Float32Array(4 * geometry.attributes['position']!.count); // black
  colours[3] = look.shadow; // the first node is the middle
  geometry.setAttribute('color', new Float32BufferAttribute(colours, 4));
  return new Mesh(geometry, new Lit().translucent());
}

/** Three rings and a cross, as on a turntable. */
function ringsOf(look: Look): LineSegments {
  const points: number[] = [];
  for (const radius of [0.35, 0.5, 0.65])
    for (let i = 0; i < 96; ++i)
      for (const k of [i, i + 1]) {
        const a = (k * Math.PI) / 48;
        points.push(radius * Math.cos(a), radius * Math.sin(a), 0);
      }
  for (let i = 0; i < 72; ++i) {
    const a = (i * Math.PI) / 36;
    const inner = i % 6 === 0 ? 0.62 : 0.64;
    points.push(inner * Math.cos(a), inner * Math.sin(a), 0, 0.65 * Math.cos(a), 0.65 * Math.sin(a), 0);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(points, 3));
  return new LineSegments(geometry, new Lit(undefined, look.floorLine).seeThrough(0.55));
}
