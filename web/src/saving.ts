/** Offers a file to the visitor for download. */
export function saveAs(name: string, content: Blob): void {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(content);
    link.download = name;
    link.click();
    // By then the browser has read the content.
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

export interface NamedMesh {
    name: string;
    vertices: ArrayLike<number>;
    faces: ArrayLike<number>;
}

/** OBJ text of some meshes. Nine digits give each single-precision number back exactly. */
export function objText(meshes: NamedMesh[], notices: string[]): string {
    const lines = notices.map((notice) => `# ${notice}`);
    let first = 1;
    for (const { name, vertices, faces } of meshes) {
        lines.push(`o ${name}`);
        for (let i = 0; i < vertices.length; i += 3) lines.push(`v ${digits(vertices[i])} ${digits(vertices[i + 1])} ${digits(vertices[i + 2])}`);
        for (let i = 0; i < faces.length; i += 3) lines.push(`f ${first + faces[i]} ${first + faces[i + 1]} ${first + faces[i + 2]}`);
        first += vertices.length / 3;
    }
    return `${lines.join('\n')}\n`;
}

const digits = (value: number): string => String(Number(value.toPrecision(9)));
