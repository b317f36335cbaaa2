// SPDX-License-Identifier: Apache-2.0
import {
  CanvasTexture,
  Color,
  DirectionalLight,
  Group,
  HemisphereLight,
  LineBasicMaterial,
  LineSegments,
  BufferGeometry,
  Float32BufferAttribute,
  Mesh as ThreeMesh,
  MeshBasicMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  Scene,
  Vector3,
  WebGLRenderer,
} from 'three';
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
  private readonly sky = new HemisphereLight(0xffffff, 0x8a8078, 1.6);
  private readonly key = new DirectionalLight(0xfff6ea, 2.1);
  private readonly rim = new DirectionalLight(0xcfe0ff, 0.7);
  private readonly floor = new Group();
  private ratio = 1;

  /** @throws Error when the browser has no WebGL 2 */
  constructor(private readonly canvas: HTMLCanvasElement) {
    this.drawnBy = nameOfRenderer();
    this.software = /swiftshader|llvmpipe|softpipe|basic render/i.test(this.drawnBy);
    this.renderer = new WebGLRenderer({ canvas, alpha: true, antialias: !this.software, powerPreference: 'high-performance' });
    this.renderer.debug.checkShaderErrors = false; // to ask waits for the shaders' compiler
    this.renderer.setClearColor(0x000000, 0);
    this.camera.up.set(0, 0, 1);
    this.scene.add(this.sky, this.key, this.key.target, this.rim, this.rim.target, this.floor);
  }

  get aspect(): number {
    return this.canvas.clientWidth / Math.max(1, this.canvas.clientHeight);
  }

  /** @param ratio pixels drawn per CSS pixel */
  resize(ratio: number): void {
    const { clientWidth: w, clientHeight: h } = this.canvas;
    if (w === 0 || h === 0) return;
    this.ratio = ratio;
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(w, h, false);
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
      if (part instanceof ThreeMesh || part instanceof LineSegments) dispose(part);
    }
    this.floor.add(shadowUnder(look), ringsOf(look));
    this.sky.groundColor = new Color(look.dark ? 0x5b5f6b : 0x9c9288);
    this.sky.intensity = look.dark ? 1.25 : 1.55;
    this.orbit.changed = true;
  }

  draw(): void {
    const { position: p, target: t } = this.orbit;
    this.camera.position.set(...p);
    this.camera.lookAt(...t);
    const { right, up } = this.orbit.axes();
    const place = (light: DirectionalLight, r: number, u: number, f: number): void => {
      light.position.set(...([0, 1, 2].map((k) => t[k] + r * right[k] + u * up[k] + f * (p[k] - t[k])) as [number, number, number]));
      light.target.position.set(...t);
    };
    const d = this.orbit.distance;
    place(this.key, -0.7 * d, 0.9 * d, 0.8);
    place(this.rim, 0.9 * d, 0.2 * d, -0.5);
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
    return { x: (0.5 + 0.5 * at.x) * this.canvas.clientWidth, y: (0.5 - 0.5 * at.y) * this.canvas.clientHeight };
  }

  /** CSS pixels per metre at the camera's target. */
  get pixelsPerMetre(): number {
    return this.canvas.clientHeight / (2 * this.orbit.distance * Math.tan(FOV / 2));
  }

  get fov(): number {
    return FOV;
  }
}

/** Asked once. Asking a context waits for all that it still draws. */
function nameOfRenderer(): string {
  const gl = document.createElement('canvas').getContext('webgl2');
  const ext = gl?.getExtension('WEBGL_debug_renderer_info');
  const name = gl ? String(gl.getParameter(ext ? ext.UNMASKED_RENDERER_WEBGL : gl.RENDERER)) : '';
  gl?.getExtension('WEBGL_lose_context')?.loseContext();
  return name;
}

/** Frees its memory on the graphics card. */
function dispose(part: ThreeMesh | LineSegments): void {
  part.geometry.dispose();
  for (const material of [part.material].flat()) {
    if (material instanceof MeshBasicMaterial) material.map?.dispose();
    material.dispose();
  }
}

function shadowUnder(look: Look): ThreeMesh {
  const size = 128;
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = size;
  const draw = canvas.getContext('2d');
  if (draw) {
    const fade = draw.createRadialGradient(size / 2, size / 2, 0, size / 2, size / 2, size / 2);
    fade.addColorStop(0, `rgba(0,0,0,${look.shadow})`);
    fade.addColorStop(0.55, `rgba(0,0,0,${0.45 * look.shadow})`);
    fade.addColorStop(1, 'rgba(0,0,0,0)');
    draw.fillStyle = fade;
    draw.fillRect(0, 0, size, size);
  }
  const material = new MeshBasicMaterial({ map: new CanvasTexture(canvas), transparent: true, depthWrite: false });
  return new ThreeMesh(new PlaneGeometry(1.1, 1.1), material);
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
  return new LineSegments(geometry, new LineBasicMaterial({ color: look.floorLine, transparent: true, opacity: 0.55 }));
}
